#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace barchan {

/// How long lists serve where particles are too fast for the checks of the rebuild schedule, whose
/// answers come two steps late: down to one step, since lists made before a step hold for it
/// whatever moves.
///
/// Lists of step s, with the largest speed v as of step c <= s, serve steps s … s + m with the
/// largest m that keeps
///
///     (2·v + g·(s + m − c)·dt) · m·dt <= skin/2
///
/// so speeds may double, beside what gravity adds. A check whose answer says that lists hold until
/// the next answer lifts this. Follows from the state alone; the same on every rank.
class ListLife {
 public:
  static constexpr int kLongest = 32;  ///< steps; slower ones are the checks' business

  struct State {
    std::int64_t end = kNever, heard_at = 0;  ///< steps
    double speed = 0.0;                       ///< [m/s]
  };

  ListLife(double skin, double dt, double gravity) : skin_(skin), dt_(dt), gravity_(gravity) {}

  void hear(double speed, std::int64_t step) { state_.speed = speed, state_.heard_at = step; }
  void lift() { state_.end = kNever; }
  void renew(std::int64_t step) {
    const int last = last_step(step);
    state_.end = last < kLongest ? step + last + 1 : kNever;
  }
  /// The step before which lists must be made anew.
  [[nodiscard]] std::int64_t end() const { return state_.end; }
  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  [[nodiscard]] int last_step(std::int64_t step) const {
    const auto heard = static_cast<double>(step - state_.heard_at);
    int m = 0;
    for (; m < kLongest; ++m) {
      const double n = m + 1.0;
      const double speed = 2.0 * state_.speed + gravity_ * (heard + n) * dt_;
      if (!(speed * n * dt_ <= 0.5 * skin_)) break;
    }
    return m;
  }

  State state_;
  double skin_, dt_, gravity_;
};

}  // namespace barchan
