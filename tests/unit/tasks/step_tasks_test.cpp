#include <barchan/tasks/step_tasks.hpp>

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace barchan {
namespace {

std::vector<GraphShape> all_shapes() {
  std::vector<GraphShape> shapes;
  for (const int num_lanes : {1, 2, 3}) {
    for (const Neighbours beside : {Neighbours{}, {-1, 1}, {0, -1}, {0, 2}, {1, 1}}) {
      for (const int way : {0, 1, 2, 3}) {
        GraphShape shape;
        shape.neighbours = beside;
        shape.is_sequential = (way & 1) != 0;
        shape.scheme = (way & 2) != 0 ? CutScheme::Returned : CutScheme::BothSides;
        for (int l = 0; l < num_lanes; ++l)
          shape.lanes.push_back(
              {1, l > 0 || beside.has(Side::Left), l + 1 < num_lanes || beside.has(Side::Right)});
        shapes.push_back(shape);
      }
    }
  }
  return shapes;
}

std::string words(const GraphShape& shape) {
  return std::to_string(shape.num_lanes()) + " lanes, neighbours " +
         std::to_string(shape.neighbours.left) + " and " + std::to_string(shape.neighbours.right) +
         (shape.is_sequential ? ", sequential" : "") + (shape.returns() ? ", returns" : "");
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

std::vector<StepTask> tasks_of_lane(const GraphShape& shape, int l) {
  std::vector<StepTask> tasks{{Work::Chunks, l}};
  if (shape.has_band(l, Side::Left)) tasks.push_back({Work::LeftBand, l});
  if (shape.has_band(l, Side::Right)) tasks.push_back({Work::RightBand, l});
  return tasks;
}

TEST(StepTasks, HaveNoCycle) {
  for (const GraphShape& shape : all_shapes())
    EXPECT_FALSE(Orders(step_tasks(shape)).has_cycle()) << words(shape);
}

TEST(StepTasks, WorkOnALaneOneAtATime) {
  for (const GraphShape& shape : all_shapes()) {
    const Orders orders(step_tasks(shape));
    for (int l = 0; l < shape.num_lanes(); ++l) {
      const auto tasks = tasks_of_lane(shape, l);
      for (std::size_t n = 1; n < tasks.size(); ++n)
        EXPECT_TRUE(orders.precedes(tasks[n - 1], 0, tasks[n], 0)) << words(shape);
      EXPECT_TRUE(orders.precedes(tasks.back(), 0, tasks.front(), 1)) << words(shape);
    }
  }
}

TEST(StepTasks, ReadBeyondACutInMemoryWhatTheStepBeforeHasWritten) {
  for (const GraphShape& shape : all_shapes()) {
    const Orders orders(step_tasks(shape));
    for (int l = 0; l + 1 < shape.num_lanes(); ++l) {
      const StepTask right{Work::RightBand, l}, left{Work::LeftBand, l + 1};
      EXPECT_TRUE(orders.precedes(right, 0, left, 1)) << words(shape);
      EXPECT_TRUE(orders.precedes(left, 0, right, 1)) << words(shape);
    }
  }
}

TEST(StepTasks, LetALaneBeAStepAheadOfTheLaneBesideIt) {
  GraphShape shape;
  shape.lanes = {{1, false, true}, {1, true, false}};

  const Orders orders(step_tasks(shape));

  EXPECT_FALSE(orders.precedes({Work::Chunks, 1}, 0, {Work::Chunks, 0}, 1));
  EXPECT_TRUE(orders.precedes({Work::Chunks, 1}, 0, {Work::Chunks, 0}, 2));
}

TEST(StepTasks, AwaitHalosBehindAllChunksOrBeforeThem) {
  for (const GraphShape& shape : all_shapes()) {
    if (shape.neighbours.left < 0 && shape.neighbours.right < 0) continue;
    const Orders orders(step_tasks(shape));
    for (int l = 0; l < shape.num_lanes(); ++l) {
      const StepTask chunks{Work::Chunks, l}, await{Work::Await};
      EXPECT_EQ(orders.precedes(await, 0, chunks, 0), shape.is_sequential) << words(shape);
      EXPECT_EQ(orders.precedes(chunks, 0, await, 0), !shape.is_sequential) << words(shape);
    }
  }
}

TEST(StepTasks, AwaitTheAnswerOfTheRightNeighbourBehindTheLeftBand) {
  for (const GraphShape& shape : all_shapes()) {
    if (!shape.returns() || shape.neighbours.left < 0 || shape.neighbours.right < 0) continue;
    const Orders orders(step_tasks(shape));

    EXPECT_TRUE(orders.precedes({Work::LeftBand, 0}, 0, {Work::AwaitRight}, 0)) << words(shape);
  }
}

TEST(StepTasks, GoOnByThemselvesOnlyWhereNoRankIsBeside) {
  for (const GraphShape& shape : all_shapes()) {
    bool goes_on = false;
    for (const StepArrow& a : step_tasks(shape).arrows)
      goes_on = goes_on || (a.way == Way::Message && a.is_next);
    const bool is_alone = shape.neighbours.left < 0 && shape.neighbours.right < 0;

    EXPECT_EQ(goes_on, is_alone && shape.num_lanes() > 1) << words(shape);
  }
}

}  // namespace
}  // namespace barchan
