#pragma once

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
  std::int64_t outside = 0;  ///< id of a particle out of the domain; 0: none; of a look
  double overlap = 0.0;      ///< as a share of the smaller radius, as last looked at; of a look
  std::int64_t particles = 0;  ///< owned
  LinkCounts imbalance;        ///< of rebuilds
  double skin = 0.0;           ///< that a rank wishes for [m]; 0: it does not
};

/// Decides when lists are rebuilt, alike on all ranks. No bit of the state depends on it.
///
/// Checks lie on multiples of kCheckEvery. A check at step s takes the exact global maximum of
/// displacement d since the last rebuild, and of speed v. The reduction has until step s + kLag to
/// come in, behind the work of kLag steps. Then, with t(n) = (2·kLag + n)·dt,
///
///     d + 2·v·t(n) + g·t(n)² <= skin/2
///
/// The next check is n steps later, for the largest n that satisfies this and is at most twice the
/// last n. Where none does, lists are rebuilt now.
///
/// t(n) reaches to the answer of the next check, and speeds may double until then. The engine
/// verifies the bound when it takes the answer: d > skin/2 means that a contact may have been
/// missed, which is an error, never silence.
///
/// Every multiple of `look_every` has a check, whatever the lists do: a look. What it tells of
/// particles outside the domain and of overlaps is part of what the run does, so it comes at fixed
/// steps.
class RebuildSchedule {
 public:
  static constexpr int kLag = 2;
  static constexpr int kCheckEvery = kLag;

  /// What a rank would like; all ranks learn with the answer whether some rank does.
  struct Wishes {
    bool stop = false, save = false;
  };
  /// A look that is begun and not answered yet, the same on every rank; for checkpoints.
  struct PendingLook {
    std::int64_t step = -1;  ///< -1: there is none
    std::int64_t outside = 0;
    double overlap = 0.0;
  };

  struct Foresight {
    CheckNumbers answer;
    std::int64_t next_check = 0;
  };

  /// @param look_every  a multiple of kCheckEvery
  RebuildSchedule(const Communicator& communicator, double skin, double dt, double gravity,
                  int look_every);

  /// Whether the check of step `step` is due, so that travel() must be called. Before the step.
  [[nodiscard]] bool is_check_due(std::int64_t step) const { return step == check_step_; }
  [[nodiscard]] bool is_look(std::int64_t step) const { return step % look_every_ == 0; }
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
  void poll();                                  ///< lets the reduction advance
  void set_skin(double skin) { skin_ = skin; }  ///< of the lists that are made next [m]
  /// Before `step` lists were made anew.
  void rebuilt(std::int64_t step);

  /// Before `step`. Waits for the look's answer.
  [[nodiscard]] PendingLook pending_look(std::int64_t step);
  /// Goes on before `step` with new lists. Collective; @pre nothing is in flight
  void restore(std::int64_t step, const PendingLook& look, std::int64_t num_particles);

  /// The rule above, for a check at `check_step`. @return step of the next check; -1: rebuild
  [[nodiscard]] std::int64_t next_check(std::int64_t check_step, double distance, double speed,
                                        int last) const;

 private:
  void wait();
  [[nodiscard]] CheckNumbers numbers() const;  ///< @pre the reduction is complete
  [[nodiscard]] std::int64_t next_check(const CheckNumbers& answer) const;
  [[nodiscard]] std::int64_t next_look(std::int64_t step) const {  ///< `step` itself, or later
    return (step + look_every_ - 1) / look_every_ * look_every_;
  }

  Reduction reduction_;
  std::optional<CheckNumbers> answer_;
  double skin_, dt_, gravity_;
  int look_every_;
  std::int64_t check_step_ = 0;
  int interval_ = 0;            ///< from the last answer to the check after it
  bool is_check_over_ = false;  ///< lists were made anew after it: only what it says of the state
  bool stop_agreed_ = false, save_agreed_ = false;
  double wait_seconds_ = 0.0;
};

}  // namespace barchan
