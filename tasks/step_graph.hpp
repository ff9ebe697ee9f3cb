#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include <barchan/core/brick/lane.hpp>
#include <barchan/tasks/halo_watch.hpp>
#include <barchan/tasks/run_options.hpp>
#include <barchan/tasks/step_clock.hpp>
#include <barchan/tasks/step_tasks.hpp>
#include <barchan/tasks/strip.hpp>
#include <barchan/tasks/task_graph.hpp>

namespace barchan {

/// One time step: the tasks of step_tasks.hpp, done by the lanes of a strip.
///
/// A rank without neighbours may run several steps at once. A lane then begins its next step when
/// its own is done, and a band waits for the band beside it, one step before, as it does between
/// ranks: a delay of one worker delays the others only if it is longer than a step.
template <int Dim>
class StepGraph {
 public:
  StepGraph(Strip<Dim>& strip, const RunOptions& options);

  /// Steps on all lanes. @return when all lanes are done and the next halo is on its way. A lane
  /// that must_stop() goes no further, nor do others that then wait for it.
  /// @param num_steps  without neighbours any number, else 1
  void run(const StepFrame& frame, int num_steps = 1);
  /// How many of the steps of the last run a lane did.
  [[nodiscard]] int steps_done(int lane) const { return steps_[static_cast<std::size_t>(lane)]; }
  /// Runs a function for every lane on the graph's threads.
  void for_each_lane(const std::function<void(int)>& body);
  [[nodiscard]] StepTimes times() const { return clock_.times(); }
  /// That a lane has worked in steps [ns].
  [[nodiscard]] std::int64_t worked(int lane) const { return clock_.worked(lane); }
  [[nodiscard]] GraphShape shape() const;
  /// Records tasks and messages from now on. @param trace  lives longer; null: stop recording
  void set_trace(Trace* trace) { clock_.set_trace(trace); }

 private:
  void begin();
  void do_task(const StepTask& task, int parity);
  void run_chunks(int lane);
  void finish_band(int lane, Side side);
  void send(int lane, Side side);
  void end_step(int lane, int parity);
  void require_all_steps() const;
  void maybe_delay();

  Strip<Dim>& strip_;
  StepClock clock_;
  GraphShape shape_;
  StepFrame frame_;
  int num_steps_ = 1;       ///< of this run
  int parity_ = 0;          ///< of its first step
  std::vector<int> steps_;  ///< that a lane has done of the run
  ExchangeHooks delays_;    ///< of tests
  std::atomic<std::uint64_t> num_delays_{0};
  TaskGraph graph_;
  bool awaits_right_;  ///< in a task of its own
  int begin_;          ///< index of a task, as what follows
  std::vector<int> chunks_;
  std::vector<int> arrived_;  ///< by link
  HaloWatch<Dim> watch_;
};

extern template class StepGraph<2>;
extern template class StepGraph<3>;

}  // namespace barchan
