// The list of a step run with tasks that only write down when they ran.
#include <barchan/tasks/task_graph.hpp>

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace barchan {
namespace {

/// Of the middle one of three ranks, or of a rank alone.
GraphShape shape_of(CutForm form, int num_lanes, bool is_alone) {
  const bool is_strips = form == CutForm::Strips;
  CutShape cuts{form, {is_alone ? 1 : 3, 1, 1}, {1, 1, 1}};
  cuts.lanes[is_strips ? 0 : 1] = num_lanes;
  return graph_shape(form, LaneMap(cuts, {true, false, false}).ties(is_alone ? 0 : 1));
}

/// Runs steps, and notes of each task in each step when it began and ended.
class Recorder {
 public:
  struct Span {
    int begin = 0, end = 0;
  };

  Recorder(const GraphShape& shape, int num_threads)
      : shape_(shape),
        graph_(step_tasks(shape), num_threads,
               [this](const StepTask& task, int parity) { record(task, parity); }),
        spans_(graph_.list().tasks.size()),
        steps_(static_cast<std::size_t>(shape.num_lanes())) {}

  void run(int num_steps) {
    const int parity = done_ % 2;
    until_ = done_ + num_steps;
    graph_.run([&] {
      for (int link = 0; link < shape_.num_links(); ++link)
        graph_.put(graph_.list().find({Work::Arrived, link}), parity);
      graph_.put(graph_.list().find({Work::Begin}), parity);
    });
    done_ = until_;
  }

  [[nodiscard]] const StepTasks& list() const { return graph_.list(); }
  /// Of a task that ran, by step.
  [[nodiscard]] const std::vector<Span>& spans(int task) const {
    return spans_[static_cast<std::size_t>(task)];
  }

 private:
  void record(const StepTask& task, int parity) {
    Span span;
    span.begin = clock_++;
    std::this_thread::yield();
    const auto at = static_cast<std::size_t>(graph_.list().find(task));
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      EXPECT_EQ(static_cast<int>(spans_[at].size()) % 2, parity);
      span.end = clock_++;
      spans_[at].push_back(span);
    }
    const bool is_lanes =
        task.work == Work::Chunks || task.work == Work::LeftBand || task.work == Work::RightBand;
    if (!is_lanes || task.work != shape_.last_work(task.lane)) return;
    if (++steps_[static_cast<std::size_t>(task.lane)] < until_)
      graph_.put(graph_.list().find({Work::Chunks, task.lane}), 1 - parity);
  }

  GraphShape shape_;
  TaskGraph graph_;
  std::vector<std::vector<Span>> spans_;
  std::vector<int> steps_;
  std::atomic<int> clock_{0};
  std::mutex mutex_;
  int done_ = 0, until_ = 0;
};

void expect_edges_kept(const Recorder& recorder, int num_steps) {
  const StepTasks& list = recorder.list();
  for (const StepArrow& a : list.arrows) {
    const auto& from = recorder.spans(a.from);
    const auto& to = recorder.spans(a.to);
    if (a.way != Way::Edge || from.empty() || to.empty()) continue;  // messages, end
    ASSERT_EQ(static_cast<int>(from.size()), num_steps);
    ASSERT_EQ(static_cast<int>(to.size()), num_steps);
    for (std::size_t s = 0; s + (a.is_next ? 1 : 0) < from.size(); ++s)
      EXPECT_LT(from[s].end, to[s + (a.is_next ? 1 : 0)].begin);
  }
}

TEST(TaskGraph, DoesEveryTaskOnceAStepBehindWhatPrecedesIt) {
  for (const int threads : {1, 3}) {
    for (const CutForm form : {CutForm::Strips, CutForm::Bricks}) {
      for (const int lanes : {1, 3}) {
        Recorder recorder(shape_of(form, lanes, false), threads);

        for (int step = 0; step < 50; ++step) recorder.run(1);

        expect_edges_kept(recorder, 50);
      }
    }
  }
}

TEST(TaskGraph, KeepsTheOrderWhereARunIsOfSeveralSteps) {
  for (const int threads : {1, 2, 3}) {
    for (const CutForm form : {CutForm::Strips, CutForm::Bricks}) {
      Recorder recorder(shape_of(form, 3, true), threads);

      recorder.run(1);
      recorder.run(40);
      recorder.run(9);

      expect_edges_kept(recorder, 50);
    }
  }
}

TEST(TaskGraph, ThrowsWhatATaskThrew) {
  TaskGraph graph(step_tasks(shape_of(CutForm::Strips, 2, true)), 2, [](const StepTask& task, int) {
    if (task.work == Work::LeftBand) throw std::runtime_error("left");
  });

  EXPECT_THROW(graph.run([&] { graph.put(graph.list().find({Work::Begin}), 0); }),
               std::runtime_error);
}

TEST(TaskGraph, RunsAFunctionForEachNumber) {
  TaskGraph graph(step_tasks(shape_of(CutForm::Strips, 2, true)), 2, [](const StepTask&, int) {});
  std::array<std::atomic<int>, 5> calls{};

  graph.for_each(5, [&](int n) { ++calls[static_cast<std::size_t>(n)]; });

  for (const auto& n : calls) EXPECT_EQ(n, 1);
}

}  // namespace
}  // namespace barchan
