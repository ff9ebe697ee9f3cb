#pragma once

#include <cstdint>

#include <barchan/comm/reduction.hpp>
#include <barchan/core/lane.hpp>

namespace barchan {

/// Decides when lists are rebuilt, from the state alone and alike on any number of ranks.
///
/// A check at step s takes the exact global maximum of displacement d since the last rebuild, and of speed v. The
/// reduction has until step s + kLag to come in, behind the work of kLag steps. Then, with t(n) = (2·kLag + n)·dt,
///
///     d + 2·v·t(n) + g·t(n)² <= skin/2   for some n <= 2·(the last n), n <= kLongest:  next check n steps later;
///     for no n >= 0:                                                                   rebuild now.
///
/// t(n) reaches to the answer of the next check, and speeds may double until then. Every check verifies the bound
/// after the fact: d > skin/2 means that a contact may have been missed, which is an error, never silence.
class RebuildSchedule {
 public:
  static constexpr int kLag = 2;
  static constexpr int kLongest = 16;

  RebuildSchedule(const Communicator& communicator, double skin, double dt, double gravity);

  /// Whether the check of step `step` is due, so that travel() must be called. Before the step.
  [[nodiscard]] bool is_check_due(std::int64_t step) const { return step == check_step_; }
  /// @param wants_stop  this rank was asked to stop; all ranks learn it with the answer
  void begin_check(const Travel& mine, bool wants_stop);

  /// The decision for `step`, before it; waits for the reduction when its time has come.
  /// Errors, the same on every rank: RunError when a particle outran the skin, left the domain or is not finite.
  [[nodiscard]] bool must_rebuild(std::int64_t step);
  [[nodiscard]] bool stop_agreed() const { return stop_agreed_; }
  void poll();  ///< lets the reduction advance
  void rebuilt(std::int64_t step);

  /// The rule above. @return steps to the next check, or -1: rebuild
  static int next_interval(double distance, double speed, double skin, double dt, double gravity, int last);

 private:
  Reduction reduction_;
  double skin_, dt_, gravity_;
  std::int64_t check_step_ = 0;
  int interval_ = 0;
  bool stop_agreed_ = false;
};

}  // namespace barchan
