#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include <barchan/comm/reduction.hpp>
#include <barchan/core/departure.hpp>

namespace barchan {

/// What a rank brings to a check, and what all ranks get out of it: largest values, sums.
struct CheckNumbers {
  double distance = 0.0;     ///< of a particle since the last rebuild [m]; NaN: a state not finite
  double speed = 0.0;        ///< [m/s]
  std::int64_t outside = 0;  ///< id of a particle out of the domain; 0: none
  double overlap = 0.0;      ///< as a share of the smaller radius, as last looked at
  std::int64_t particles = 0;  ///< owned
  LinkCounts imbalance;        ///< of rebuilds
};

/// Decides when lists are rebuilt, from the state alone and alike on any number of ranks.
///
/// A check at step s takes the exact global maximum of displacement d since the last rebuild, and
/// of speed v. The reduction has until step s + kLag to come in, behind the work of kLag steps.
/// Then, with t(n) = (2·kLag + n)·dt,
///
///     d + 2·v·t(n) + g·t(n)² <= skin/2
///
/// The next check is n steps later, for the largest n that satisfies this, is at most twice the
/// last n, and at most kLongest. Where not even n = 0 does, lists are rebuilt now.
///
/// t(n) reaches to the answer of the next check, and speeds may double until then. The engine
/// verifies the bound when it takes the answer: d > skin/2 means that a contact may have been
/// missed, which is an error, never silence.
class RebuildSchedule {
 public:
  static constexpr int kLag = 2;
  static constexpr int kLongest = 16;

  /// What a rank would like; all ranks learn with the answer whether some rank does.
  struct Wishes {
    bool stop = false, save = false;
  };
  /// What follows from the past, the same on every rank.
  struct State {
    std::int64_t check_step = 0;
    int interval = 0;
    bool has_check = false;          ///< begun, not yet answered
    std::array<double, 4> check{};   ///< its answer: distance, speed, id outside, overlap
    std::int64_t num_particles = 0;  ///< its answer, too
  };

  struct Foresight {
    CheckNumbers answer;
    std::int64_t next_check = 0;
  };

  RebuildSchedule(const Communicator& communicator, double skin, double dt, double gravity);

  /// Whether the check of step `step` is due, so that travel() must be called. Before the step.
  [[nodiscard]] bool is_check_due(std::int64_t step) const { return step == check_step_; }
  /// The first step after `step` before which a check is due, or the answer of one.
  [[nodiscard]] std::int64_t next_part(std::int64_t step) const {
    return step < check_step_ ? check_step_ : check_step_ + kLag;
  }
  void begin_check(const CheckNumbers& mine, Wishes wishes);

  /// The decision for `step`, before it; waits for the reduction when its time has come.
  [[nodiscard]] bool must_rebuild(std::int64_t step);
  /// On a lone rank: the answer of the check just begun, kLag steps early, and the step of the next
  /// check; none, if lists will be rebuilt or some rank had a wish. Changes nothing.
  [[nodiscard]] std::optional<Foresight> foresee();
  /// What the check found that the last must_rebuild() had the answer of; once.
  [[nodiscard]] std::optional<CheckNumbers> take_answer() {
    return std::exchange(answer_, std::nullopt);
  }
  /// Whether some rank wished to stop; true once.
  [[nodiscard]] bool take_stop_agreed() { return std::exchange(stop_agreed_, false); }
  /// Whether some rank wished to save; true once.
  [[nodiscard]] bool take_save_agreed() { return std::exchange(save_agreed_, false); }
  [[nodiscard]] double wait_seconds() const { return wait_seconds_; }  ///< for answers
  void poll();                      ///< lets the reduction advance
  void rebuilt(std::int64_t step);  ///< lists were made anew before `step`

  /// For checkpoints, before `step`. Waits for a check's answer.
  [[nodiscard]] State state(std::int64_t step);
  /// As if the checks since the start had been made. Collective; @pre nothing is in flight
  void restore(const State& state, bool is_root);

  /// The rule above. @return steps to the next check, or -1: rebuild
  static int next_interval(double distance, double speed, double skin, double dt, double gravity,
                           int last);

 private:
  Reduction reduction_;
  std::optional<CheckNumbers> answer_;
  double skin_, dt_, gravity_;
  std::int64_t check_step_ = 0;
  int interval_ = 0;
  bool is_asked_ = false;  ///< the check is begun, and not answered
  bool stop_agreed_ = false, save_agreed_ = false;
  double wait_seconds_ = 0.0;

  void wait();
  [[nodiscard]] CheckNumbers numbers() const;  ///< @pre the reduction is complete
};

}  // namespace barchan
