#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include <barchan/comm/base/reduction.hpp>
#include <barchan/core/checkpoint/state.hpp>

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
/// Lists serve from the step that they are made for, whatever moves: so they may be made anew in
/// every step, and a step that is stable runs on however fast particles are. They serve n steps
/// more, for the largest n that satisfies
///
///     d + (2·v + g·t)·n·dt <= skin/2
///
/// where d is the largest displacement so far, 0 for new lists; v the largest speed as last known;
/// t the time since then until the n-th step. So speeds may double, beside what gravity adds.
///
/// A check at step s takes the exact global maxima of d and v. The reduction has until step
/// s + lag to come in, behind the work of these steps; the rule with its numbers says anew when
/// lists end. Checks lie on multiples of kCheckEvery. The next one comes as late as its answer may,
/// before lists end, and at most after twice the time since the last one. The lag is kLag, or more
/// where messages take longer than steps.
///
/// The engine verifies the bound when it takes the answer: d > skin/2 means that a contact may have
/// been missed, which is an error, never silence.
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
  struct Foresight {
    CheckNumbers answer;
    std::int64_t next_check = 0;
  };

  /// @param look_every  a multiple of kCheckEvery
  /// @param lag  an even number, at most look_every
  RebuildSchedule(const Communicator& communicator, double skin, double dt, double gravity,
                  int look_every, int lag = kLag);

  /// Whether the check of step `step` is due, so that travel() must be called. Before the step.
  [[nodiscard]] bool is_check_due(std::int64_t step) const { return step == check_step_; }
  [[nodiscard]] bool is_look(std::int64_t step) const { return step % look_every_ == 0; }
  /// The first step after `step` before which a check is due, or the answer of one, or new lists.
  [[nodiscard]] std::int64_t next_part(std::int64_t step) const {
    return std::min(step < check_step_ ? check_step_ : check_step_ + lag_, lists_end_);
  }
  [[nodiscard]] double speed() const { return speed_; }  ///< the largest, as last known [m/s]
  void begin_check(const CheckNumbers& mine, Wishes wishes);

  /// The decision for `step`, before it; waits for the reduction when its time has come.
  [[nodiscard]] bool must_rebuild(std::int64_t step);
  /// On a lone rank: the answer of the check just begun, lag steps early, and the step of the next
  /// check; none, if lists end before its answer or some rank had a wish. Changes nothing.
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
  /// The first lists were made before `step`. @param speed  the largest of all ranks [m/s]
  void begin(std::int64_t step, double speed);

  /// Before `step`. Waits for the look's answer.
  [[nodiscard]] PendingLook pending_look(std::int64_t step);
  /// As begin(). Collective; @pre nothing is in flight
  void restore(std::int64_t step, double speed, const PendingLook& look,
               std::int64_t num_particles);

  /// All that it knows between two steps; `check` where a check is on its way.
  struct Memory {
    double skin = 0.0, dt = 0.0, gravity = 0.0, speed = 0.0;
    std::int64_t speed_step = 0, lists_step = 0, lists_end = 0, check_step = 0;
    int interval = 0;
    bool is_check_over = false;
    std::optional<CheckNumbers> check;
  };
  /// Before `step`. Waits for a check on its way. Collective.
  [[nodiscard]] Memory memory(std::int64_t step);
  /// Before `step`, all is as it was then; wishes on their way are to be made again. Collective.
  void recall(std::int64_t step, const Memory& memory);
  /// Before `step`, a caller changed what no check on its way knows. Collective.
  /// @param newcomers  of all ranks; below 0: particles that went
  /// @param speed      that something may have now [m/s]
  void amend(std::int64_t step, std::int64_t newcomers, double speed);
  /// Before a step from which on they have this length; lists must be made anew. Shorter ones
  /// between these need no call [s].
  void set_step_length(double dt) { dt_ = dt; }
  /// @return whether it is more than lists allow for, so that new ones must be made
  bool raise_gravity(double gravity) {
    const bool is_more = gravity > gravity_;
    gravity_ = std::max(gravity_, gravity);
    return is_more;
  }

  /// The rule above, with d and v as of step `from`. @return the first step without lists
  [[nodiscard]] std::int64_t end_of_lists(std::int64_t from, double distance, double speed,
                                          std::int64_t speed_step) const;

 private:
  struct Outlook {
    std::int64_t lists_end = 0, next_check = 0;
  };
  void wait();
  [[nodiscard]] CheckNumbers numbers() const;  ///< @pre the reduction is complete
  /// @param answer_step  before which it is known
  [[nodiscard]] Outlook outlook(const CheckNumbers& answer, std::int64_t answer_step) const;
  /// From `first` on about `wanted`, with its answer before lists end where that can be.
  [[nodiscard]] std::int64_t check_in(std::int64_t first, std::int64_t wanted,
                                      std::int64_t lists_end) const;
  [[nodiscard]] std::int64_t next_look(std::int64_t step) const {  ///< `step` itself, or later
    return (step + look_every_ - 1) / look_every_ * look_every_;
  }

  bool is_root_;
  Reduction reduction_;
  std::optional<CheckNumbers> answer_;
  double skin_, dt_, gravity_;
  double check_skin_ = 0.0;  ///< that lists had at the last check [m]
  int look_every_, lag_;
  double speed_ = 0.0;                       ///< the largest, as last known [m/s], and
  std::int64_t speed_step_ = 0;              ///< of which step
  std::int64_t lists_step_ = 0, lists_end_;  ///< steps that lists serve: [begin, end)
  std::int64_t check_step_ = 0;
  int interval_ = 0;            ///< from the last answer to the check after it
  bool is_check_over_ = false;  ///< lists were made anew after it: only what it says of the state
  bool stop_agreed_ = false, save_agreed_ = false;
  double wait_seconds_ = 0.0;
};

}  // namespace barchan
