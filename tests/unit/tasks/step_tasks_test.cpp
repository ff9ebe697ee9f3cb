#include <barchan/tasks/step_tasks.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace barchan {
namespace {

struct Case {
  GraphShape shape;
  std::string words;
};

std::vector<Case> all_shapes() {
  std::vector<CutShape> cuts;
  for (const int ranks : {1, 2, 3}) {
    for (const int lanes : {1, 2, 3})
      cuts.push_back({CutForm::Strips, {ranks, 1, 1}, {lanes, 1, 1}});
  }
  cuts.push_back({CutForm::Bricks, {2, 2, 1}, {1, 1, 1}});
  cuts.push_back({CutForm::Bricks, {2, 1, 1}, {1, 3, 1}});
  cuts.push_back({CutForm::Bricks, {1, 1, 1}, {2, 1, 2}});
  std::vector<Case> cases;
  for (const CutShape& cut : cuts) {
    for (const int way : {0, 1, 2, 3, 4, 5}) {
      const bool is_periodic = (way & 1) != 0, returns = way >= 4;
      if (returns && cut.form == CutForm::Bricks) continue;
      const LaneMap map(cut, {is_periodic, is_periodic, false});
      for (int rank = 0; rank < cut.num_ranks(); ++rank) {
        Case c{graph_shape(cut.form, map.ties(rank)), ""};
        c.shape.is_sequential = (way & 2) != 0;
        c.shape.scheme = returns ? CutScheme::Returned : CutScheme::BothSides;
        c.words =
            fmt::format("{} {}, rank {} of {}, lanes {}{}{}{}",
                        cut.form == CutForm::Strips ? "strips" : "bricks", cases.size(), rank,
                        cut.num_ranks(), cut.num_lanes(), is_periodic ? ", periodic" : "",
                        c.shape.is_sequential ? ", sequential" : "", returns ? ", returns" : "");
        cases.push_back(c);
      }
    }
  }
  return cases;
}

bool is_alone(const GraphShape& shape) {
  return shape.num_links() == 0;
}

/// Tasks of three steps and what the list's edges say of them, directly or not.
class Orders {
 public:
  static constexpr int kSteps = 3;

  explicit Orders(StepTasks list) : list_(std::move(list)) {
    for (int step = 0; step < kSteps; ++step) {
      for (const StepArrow& a : list_.arrows) {
        if (a.way == Way::Edge && step + (a.is_next ? 1 : 0) < kSteps)
          direct_.insert({number(a.from, step), number(a.to, step + (a.is_next ? 1 : 0))});
      }
    }
  }
  [[nodiscard]] bool precedes(const StepTask& from, int step, const StepTask& to, int later) const {
    return reaches(number(list_.find(from), step), number(list_.find(to), step + later));
  }
  [[nodiscard]] bool has_cycle() const {
    const int num = kSteps * static_cast<int>(list_.tasks.size());
    for (int n = 0; n < num; ++n) {
      if (reaches(n, n)) return true;
    }
    return false;
  }

 private:
  [[nodiscard]] int number(int task, int step) const {
    return task < 0 ? -1 : step * static_cast<int>(list_.tasks.size()) + task;
  }
  [[nodiscard]] bool reaches(int from, int to) const {
    std::set<int> seen;
    std::vector<int> open{from};
    while (!open.empty()) {
      const int here = open.back();
      open.pop_back();
      for (auto at = direct_.lower_bound({here, 0}); at != direct_.end() && at->first == here;
           ++at) {
        if (at->second == to) return true;
        if (seen.insert(at->second).second) open.push_back(at->second);
      }
    }
    return false;
  }

  StepTasks list_;
  std::set<std::pair<int, int>> direct_;
};

StepTask band(int lane, Side side) {
  return {side == Side::Left ? Work::LeftBand : Work::RightBand, lane};
}

std::vector<StepTask> tasks_of_lane(const GraphShape& shape, int l) {
  std::vector<StepTask> tasks{{Work::Chunks, l}};
  if (shape.has_band(l, Side::Left)) tasks.push_back({Work::LeftBand, l});
  if (shape.has_band(l, Side::Right)) tasks.push_back({Work::RightBand, l});
  return tasks;
}

TEST(StepTasks, HaveNoCycle) {
  for (const auto& [shape, words] : all_shapes())
    EXPECT_FALSE(Orders(step_tasks(shape)).has_cycle()) << words;
}

TEST(StepTasks, WorkOnALaneOneAtATime) {
  for (const auto& [shape, words] : all_shapes()) {
    const Orders orders(step_tasks(shape));
    for (int l = 0; l < shape.num_lanes(); ++l) {
      const auto tasks = tasks_of_lane(shape, l);
      for (std::size_t n = 1; n < tasks.size(); ++n)
        EXPECT_TRUE(orders.precedes(tasks[n - 1], 0, tasks[n], 0)) << words;
      EXPECT_TRUE(orders.precedes(tasks.back(), 0, tasks.front(), 1)) << words;
    }
  }
}

TEST(StepTasks, ReadBeyondACutInMemoryWhatTheStepBeforeHasWritten) {
  for (const auto& [shape, words] : all_shapes()) {
    const Orders orders(step_tasks(shape));
    for (int l = 0; l < shape.num_lanes(); ++l) {
      for (const LaneTie& tie : shape.ties(l)) {
        if (tie.link >= 0) continue;
        const LaneTie& back = shape.ties(tie.lane)[static_cast<std::size_t>(tie.back)];
        EXPECT_EQ(back.lane, l) << words;
        EXPECT_TRUE(
            orders.precedes(band(l, shape.sending_band(tie)), 0, band(tie.lane, back.side), 1))
            << words;
      }
    }
  }
}

TEST(StepTasks, WaitForEveryLinkInTheBandThatItIsOf) {
  for (const auto& [shape, words] : all_shapes()) {
    const Orders orders(step_tasks(shape));
    for (int l = 0; l < shape.num_lanes(); ++l) {
      for (const LaneTie& tie : shape.ties(l)) {
        if (tie.link < 0) continue;
        EXPECT_TRUE(orders.precedes({Work::Arrived, tie.link}, 0, band(l, tie.side), 0)) << words;
      }
    }
  }
}

TEST(StepTasks, LetALaneBeAStepAheadOfTheLaneBesideIt) {
  const LaneMap map({CutForm::Strips, {1, 1, 1}, {2, 1, 1}}, {});
  const GraphShape shape = graph_shape(CutForm::Strips, map.ties(0));

  const Orders orders(step_tasks(shape));

  EXPECT_FALSE(orders.precedes({Work::Chunks, 1}, 0, {Work::Chunks, 0}, 1));
  EXPECT_TRUE(orders.precedes({Work::Chunks, 1}, 0, {Work::Chunks, 0}, 2));
}

TEST(StepTasks, AwaitHalosBehindAllChunksOrBeforeThem) {
  for (const auto& [shape, words] : all_shapes()) {
    if (is_alone(shape)) continue;
    const Orders orders(step_tasks(shape));
    for (int l = 0; l < shape.num_lanes(); ++l) {
      const StepTask chunks{Work::Chunks, l}, await{Work::Await};
      EXPECT_EQ(orders.precedes(await, 0, chunks, 0), shape.is_sequential) << words;
      EXPECT_EQ(orders.precedes(chunks, 0, await, 0), !shape.is_sequential) << words;
    }
  }
}

TEST(StepTasks, AwaitTheAnswerOfTheRightNeighbourBehindTheLeftBand) {
  for (const auto& [shape, words] : all_shapes()) {
    if (!shape.returns() || !shape.awaits(Side::Left) || !shape.awaits(Side::Right)) continue;
    const Orders orders(step_tasks(shape));

    EXPECT_TRUE(orders.precedes({Work::LeftBand, 0}, 0, {Work::AwaitRight}, 0)) << words;
  }
}

TEST(StepTasks, GoOnByThemselvesOnlyWhereNoRankIsBeside) {
  for (const auto& [shape, words] : all_shapes()) {
    bool goes_on = false;
    for (const StepArrow& a : step_tasks(shape).arrows)
      goes_on = goes_on || (a.way == Way::Message && a.is_next);

    EXPECT_EQ(goes_on, is_alone(shape) && shape.num_lanes() > 1) << words;
  }
}

}  // namespace
}  // namespace barchan
