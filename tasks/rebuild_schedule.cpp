#include <barchan/tasks/rebuild_schedule.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <barchan/comm/clock.hpp>
#include <barchan/core/error.hpp>

namespace barchan {

RebuildSchedule::RebuildSchedule(const Communicator& communicator, double skin, double dt,
                                 double gravity)
    : reduction_(communicator, 5, 0), skin_(skin), dt_(dt), gravity_(gravity) {}

int RebuildSchedule::next_interval(double distance, double speed, double skin, double dt,
                                   double gravity, int last) {
  const auto is_safe = [&](int n) {
    const double t = (2 * kLag + n) * dt;
    return distance + 2.0 * speed * t + gravity * t * t <= 0.5 * skin;
  };
  if (!is_safe(0)) return -1;
  int n = std::clamp(2 * last, 1, kLongest);
  while (n > 0 && !is_safe(n)) --n;
  return n;
}

void RebuildSchedule::begin_check(const Travel& mine, Wishes wishes) {
  const double maxima[5] = {mine.distance2, mine.speed2, static_cast<double>(mine.outside),
                            wishes.stop ? 1.0 : 0.0, wishes.save ? 1.0 : 0.0};
  reduction_.begin(maxima, {});
}

void RebuildSchedule::poll() {
  if (reduction_.is_in_flight()) (void)reduction_.test();
}

void RebuildSchedule::wait() {
  const std::int64_t begin = now_ns();
  reduction_.wait();
  wait_seconds_ += 1e-9 * static_cast<double>(now_ns() - begin);
}

bool RebuildSchedule::must_rebuild(std::int64_t step) {
  if (step != check_step_ + kLag) return false;
  wait();
  const auto maxima = reduction_.maxima();
  stop_agreed_ = maxima[3] > 0.0;
  save_agreed_ = maxima[4] > 0.0;
  const double distance = std::sqrt(maxima[0]), speed = std::sqrt(maxima[1]);
  if (!std::isfinite(distance) || !std::isfinite(speed)) {
    throw RunError(
        fmt::format("at step {} the state is no longer finite: a smaller time.step, more damping "
                    "or less overlap at the "
                    "start would help",
                    step - kLag));
  }
  if (maxima[2] > 0.0) {
    throw RunError(
        fmt::format("at step {} particle {} has left the domain: enlarge domain.lo and domain.hi, "
                    "or put a wall there",
                    step - kLag, static_cast<std::int64_t>(maxima[2])));
  }
  if (distance > 0.5 * skin_) {
    throw RunError(
        fmt::format("at step {} a particle had moved {:.3g} m since the lists were built, more "
                    "than half the skin of {:.3g} m "
                    "(largest speed {:.3g} m/s): contacts may have been missed; give a larger "
                    "search.skin or a smaller "
                    "time.step",
                    step - kLag, distance, skin_, speed));
  }
  const int n = next_interval(distance, speed, skin_, dt_, gravity_, interval_);
  if (n < 0) return true;
  interval_ = n;
  check_step_ = step + n;
  return false;
}

void RebuildSchedule::rebuilt(std::int64_t step) {
  if (reduction_.is_in_flight()) wait();  // a rebuild for another reason; the answer is stale
  interval_ = std::max(interval_ / 2, 1);
  check_step_ = step + interval_;
}

RebuildSchedule::State RebuildSchedule::state(std::int64_t step) {
  State s{check_step_, interval_, check_step_ < step, {}};
  if (!s.has_check) return s;
  reduction_.wait();
  std::copy_n(reduction_.maxima().begin(), s.check.size(), s.check.begin());
  return s;
}

void RebuildSchedule::restore(const State& state) {
  check_step_ = state.check_step;
  interval_ = state.interval;
  if (!state.has_check) return;
  const double maxima[5] = {state.check[0], state.check[1], state.check[2], 0.0, 0.0};
  reduction_.begin(maxima, {});
}

}  // namespace barchan
