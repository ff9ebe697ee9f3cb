#include <barchan/tasks/lane_map.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace barchan {
namespace {

struct Case {
  CutShape shape;
  std::array<bool, 3> is_periodic;
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (int periodicity = 0; periodicity < 8; ++periodicity) {
    const std::array<bool, 3> p{(periodicity & 1) != 0, (periodicity & 2) != 0,
                                (periodicity & 4) != 0};
    for (const auto& ranks : {std::array{1, 1, 1}, {2, 1, 1}, {3, 2, 1}, {2, 2, 2}, {1, 4, 3}}) {
      for (const auto& lanes : {std::array{1, 1, 1}, {1, 2, 1}, {2, 1, 2}})
        cases.push_back({{CutForm::Bricks, ranks, lanes}, p});
    }
    for (const int ranks : {1, 2, 3}) {
      for (const int lanes : {1, 2, 3})
        cases.push_back({{CutForm::Strips, {ranks, 1, 1}, {lanes, 1, 1}}, p});
    }
  }
  return cases;
}

std::string words(const Case& c) {
  return fmt::format("{} ranks {}x{}x{} of {}x{}x{} lanes, periodic {}{}{}",
                     c.shape.form == CutForm::Strips ? "strips" : "bricks", c.shape.ranks[0],
                     c.shape.ranks[1], c.shape.ranks[2], c.shape.lanes[0], c.shape.lanes[1],
                     c.shape.lanes[2], int{c.is_periodic[0]}, int{c.is_periodic[1]},
                     int{c.is_periodic[2]});
}

TEST(LaneMap, LeadsBackOverEveryTie) {
  for (const Case& c : all_cases()) {
    const LaneMap map(c.shape, c.is_periodic);
    for (int rank = 0; rank < c.shape.num_ranks(); ++rank) {
      const auto ties = map.ties(rank);
      for (int lane = 0; lane < c.shape.num_lanes(); ++lane) {
        const auto& mine = ties[static_cast<std::size_t>(lane)];
        for (std::size_t t = 0; t < mine.size(); ++t) {
          const auto theirs = map.ties(mine[t].rank);
          const LaneTie& back = theirs[static_cast<std::size_t>(mine[t].lane)]
                                      [static_cast<std::size_t>(mine[t].back)];
          EXPECT_EQ(back.rank, rank) << words(c);
          EXPECT_EQ(back.lane, lane) << words(c);
          EXPECT_EQ(back.back, static_cast<int>(t)) << words(c);
          EXPECT_EQ(back.side, opposite(mine[t].side)) << words(c);
          EXPECT_EQ(back.link, mine[t].peer) << words(c);
          EXPECT_EQ(back.peer, mine[t].link) << words(c);
        }
      }
    }
  }
}

TEST(LaneMap, NumbersTheLinksOfARankFromZeroOn) {
  for (const Case& c : all_cases()) {
    const LaneMap map(c.shape, c.is_periodic);
    for (int rank = 0; rank < c.shape.num_ranks(); ++rank) {
      int next = 0;
      for (const auto& of_lane : map.ties(rank)) {
        for (const LaneTie& tie : of_lane) {
          EXPECT_EQ(tie.link >= 0, tie.rank != rank) << words(c);
          if (tie.link < 0) continue;
          EXPECT_EQ(tie.link, next++) << words(c);
        }
      }
      EXPECT_EQ(neighbours_of(map.ties(rank)).num_links(), next) << words(c);
    }
  }
}

/// Coordinates differ by at most one along each axis, around the ends where it is periodic.
bool are_beside(const Case& c, const LaneMap::Place& a, const LaneMap::Place& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    const int n = c.shape.along(static_cast<int>(k)), apart = std::abs(a[k] - b[k]);
    if (apart > 1 && !(c.is_periodic[k] && apart == n - 1)) return false;
  }
  return true;
}

TEST(LaneMap, TiesABrickOnceToEveryOtherThatTouches) {
  for (const Case& c : all_cases()) {
    if (c.shape.form == CutForm::Strips) continue;
    const LaneMap map(c.shape, c.is_periodic);
    for (int rank = 0; rank < c.shape.num_ranks(); ++rank) {
      const auto ties = map.ties(rank);
      for (int lane = 0; lane < c.shape.num_lanes(); ++lane) {
        std::multiset<std::pair<int, int>> found, expected;
        for (const LaneTie& tie : ties[static_cast<std::size_t>(lane)])
          found.emplace(tie.rank, tie.lane);
        for (int r = 0; r < c.shape.num_ranks(); ++r) {
          for (int l = 0; l < c.shape.num_lanes(); ++l) {
            if ((r != rank || l != lane) && are_beside(c, map.place(rank, lane), map.place(r, l)))
              expected.emplace(r, l);
          }
        }
        EXPECT_EQ(found, expected) << words(c);
      }
    }
  }
}

TEST(LaneMap, GivesStripsInARingOfTwoALeftAndARightTie) {
  const LaneMap map({CutForm::Strips, {2, 1, 1}, {1, 1, 1}}, {true, false, false});

  const Neighbours beside = neighbours_of(map.ties(0));

  ASSERT_EQ(beside.num_links(), 2);
  EXPECT_EQ(beside.rank(0), 1);
  EXPECT_EQ(beside.rank(1), 1);
  EXPECT_EQ(beside.peer(0), 1);
  EXPECT_EQ(beside.peer(1), 0);
}

}  // namespace
}  // namespace barchan
