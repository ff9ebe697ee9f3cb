#include <barchan/tasks/lane_map.hpp>

#include <algorithm>
#include <map>

namespace barchan {
namespace {

/// The place of a number among shape[0] × shape[1] × shape[2], the last axis fastest.
std::array<int, 3> unfold(int number, const std::array<int, 3>& shape) {
  const int rest = number / shape[2];
  return {rest / shape[1], rest % shape[1], number % shape[2]};
}

int fold(const std::array<int, 3>& at, const std::array<int, 3>& shape) {
  return (at[0] * shape[1] + at[1]) * shape[2] + at[2];
}

}  // namespace

LaneMap::LaneMap(const CutShape& shape, const std::array<bool, 3>& is_periodic)
    : shape_(shape), is_periodic_(is_periodic) {}

auto LaneMap::place(int rank, int lane) const -> Place {
  Place at = unfold(rank, shape_.ranks);
  const Place within = unfold(lane, shape_.lanes);
  for (std::size_t k = 0; k < 3; ++k) at[k] = at[k] * shape_.lanes[k] + within[k];
  return at;
}

LaneTie LaneMap::tie_to(const Place& at) const {
  Place rank{}, within{};
  for (std::size_t k = 0; k < 3; ++k) {
    rank[k] = at[k] / shape_.lanes[k];
    within[k] = at[k] % shape_.lanes[k];
  }
  LaneTie tie;
  tie.rank = fold(rank, shape_.ranks);
  tie.lane = fold(within, shape_.lanes);
  return tie;
}

void LaneMap::add_strip_ties(int at, std::vector<LaneTie>& ties) const {
  const int n = shape_.along(0);
  for (const Side side : kSides) {
    const int beside = side == Side::Left ? at - 1 : at + 1;
    const bool is_there = (beside >= 0 && beside < n) || (is_periodic_[0] && n > 1);
    if (!is_there) continue;
    ties.push_back(tie_to({(beside + n) % n, 0, 0}));
    ties.back().side = side;
  }
}

void LaneMap::add_brick_ties(const Place& at, std::vector<LaneTie>& ties) const {
  constexpr int kAround = 27;
  for (int n = 0; n < kAround; ++n) {
    const Place step{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
    Place to = at;
    bool is_there = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const int along = shape_.along(static_cast<int>(k));
      to[k] += step[k];
      if (is_periodic_[k]) to[k] = (to[k] + along) % along;
      is_there = is_there && to[k] >= 0 && to[k] < along;
    }
    if (is_there && to != at) ties.push_back(tie_to(to));
  }
  const auto by_number = [this](const LaneTie& a, const LaneTie& b) {
    return number(a) < number(b);
  };
  const auto is_same = [this](const LaneTie& a, const LaneTie& b) {
    return number(a) == number(b);
  };
  std::sort(ties.begin(), ties.end(), by_number);
  ties.erase(std::unique(ties.begin(), ties.end(), is_same), ties.end());
  const int own = number(tie_to(at));
  for (LaneTie& tie : ties) tie.side = number(tie) < own ? Side::Left : Side::Right;
}

std::vector<LaneTie> LaneMap::ties_of(int rank, int lane) const {
  std::vector<LaneTie> ties;
  const Place at = place(rank, lane);
  if (shape_.form == CutForm::Strips)
    add_strip_ties(at[0], ties);
  else
    add_brick_ties(at, ties);
  return ties;
}

/// What is left here is right there.
int LaneMap::back_of(const LaneTie& tie, int rank, int lane) const {
  const std::vector<LaneTie> theirs = ties_of(tie.rank, tie.lane);
  const auto found = std::ranges::find_if(theirs, [&](const LaneTie& back) {
    return back.rank == rank && back.lane == lane && back.side == opposite(tie.side);
  });
  return static_cast<int>(found - theirs.begin());
}

std::vector<std::vector<LaneTie>> LaneMap::with_links(int rank) const {
  std::vector<std::vector<LaneTie>> of_lanes;
  int num_links = 0;
  for (int lane = 0; lane < shape_.num_lanes(); ++lane) {
    of_lanes.push_back(ties_of(rank, lane));
    for (LaneTie& tie : of_lanes.back()) {
      tie.back = back_of(tie, rank, lane);
      if (tie.rank != rank) tie.link = num_links++;
    }
  }
  return of_lanes;
}

std::vector<std::vector<LaneTie>> LaneMap::ties(int rank) const {
  std::vector<std::vector<LaneTie>> of_lanes = with_links(rank);
  std::map<int, std::vector<std::vector<LaneTie>>> of_ranks;
  for (auto& of_lane : of_lanes) {
    for (LaneTie& tie : of_lane) {
      if (tie.link < 0) continue;
      const auto [theirs, is_new] = of_ranks.try_emplace(tie.rank);
      if (is_new) theirs->second = with_links(tie.rank);
      tie.peer =
          theirs->second[static_cast<std::size_t>(tie.lane)][static_cast<std::size_t>(tie.back)]
              .link;
    }
  }
  return of_lanes;
}

Neighbours neighbours_of(const std::vector<std::vector<LaneTie>>& ties) {
  Neighbours found;
  for (const auto& of_lane : ties) {
    for (const LaneTie& tie : of_lane) {
      if (tie.link >= 0) found.links.push_back({tie.rank, tie.peer});
    }
  }
  return found;
}

template <int Dim>
Placement<Dim> placement(const LaneMap& map, const Cuts& cuts, int rank, int lane,
                         const std::vector<LaneTie>& ties) {
  const auto box_of = [&](int of_rank, int of_lane) {
    CellBox<Dim> box;
    const LaneMap::Place at = map.place(of_rank, of_lane);
    for (std::size_t k = 0; k < Dim; ++k) {
      box.lo[k] = cuts[k][static_cast<std::size_t>(at[k])];
      box.hi[k] = cuts[k][static_cast<std::size_t>(at[k]) + 1];
    }
    return box;
  };
  Placement<Dim> found{box_of(rank, lane), {}};
  for (const LaneTie& tie : ties) found.beyond.push_back(box_of(tie.rank, tie.lane));
  return found;
}

template Placement<2> placement(const LaneMap&, const Cuts&, int, int, const std::vector<LaneTie>&);
template Placement<3> placement(const LaneMap&, const Cuts&, int, int, const std::vector<LaneTie>&);

}  // namespace barchan
