#include <barchan/tasks/rebuild_schedule.hpp>

#include <algorithm>

#include <barchan/comm/clock.hpp>

namespace barchan {
namespace {

constexpr std::size_t kMaxima = 7, kSums = 4;

/// The multiple of kCheckEvery that is `step` or follows it.
std::int64_t check_from(std::int64_t step) {
  constexpr std::int64_t kEvery = RebuildSchedule::kCheckEvery;
  return (step + kEvery - 1) / kEvery * kEvery;
}

}  // namespace

RebuildSchedule::RebuildSchedule(const Communicator& communicator, double skin, double dt,
                                 double gravity, int look_every)
    : reduction_(communicator, kMaxima, kSums),
      skin_(skin),
      dt_(dt),
      gravity_(gravity),
      look_every_(look_every) {}

std::int64_t RebuildSchedule::next_check(std::int64_t check_step, double distance, double speed,
                                         int last) const {
  const std::int64_t answer_step = check_step + kLag;
  const auto is_safe = [&](std::int64_t check) {
    const double t = static_cast<double>(2 * kLag + check - answer_step) * dt_;
    return distance + 2.0 * speed * t + gravity_ * t * t <= 0.5 * skin_;
  };
  const std::int64_t first = check_step + kCheckEvery;
  std::int64_t check =
      std::min(check_from(answer_step + std::max(2 * last, 1)), next_look(check_step + 1));
  while (check > first && !is_safe(check)) check -= kCheckEvery;
  return is_safe(check) ? check : -1;
}

std::int64_t RebuildSchedule::next_check(const CheckNumbers& answer) const {
  if (is_check_over_) return check_step_ + kCheckEvery;
  return next_check(check_step_, answer.distance, answer.speed, interval_);
}

void RebuildSchedule::begin_check(const CheckNumbers& mine, Wishes wishes) {
  is_check_over_ = false;
  const double maxima[kMaxima] = {mine.distance,
                                  mine.speed,
                                  static_cast<double>(mine.outside),
                                  mine.overlap,
                                  wishes.stop ? 1.0 : 0.0,
                                  wishes.save ? 1.0 : 0.0,
                                  mine.skin};
  const std::int64_t sums[kSums] = {mine.particles, mine.imbalance.contacts,
                                    mine.imbalance.wall_contacts, mine.imbalance.bonds};
  reduction_.begin(maxima, sums);
}

void RebuildSchedule::poll() {
  if (reduction_.is_in_flight()) (void)reduction_.test();
}

void RebuildSchedule::wait() {
  const std::int64_t begin = now_ns();
  reduction_.wait();
  wait_seconds_ += 1e-9 * static_cast<double>(now_ns() - begin);
}

CheckNumbers RebuildSchedule::numbers() const {
  const auto maxima = reduction_.maxima();
  const auto sums = reduction_.sums();
  return {maxima[0], maxima[1], static_cast<std::int64_t>(maxima[2]),
          maxima[3], sums[0],   {sums[1], sums[2], sums[3]},
          maxima[6]};
}

std::optional<RebuildSchedule::Foresight> RebuildSchedule::foresee() {
  wait();
  const CheckNumbers answer = numbers();
  const std::int64_t next = next_check(answer);
  const bool has_wish = reduction_.maxima()[4] > 0.0 || reduction_.maxima()[5] > 0.0 ||
                        (answer.skin > 0.0 && answer.skin != skin_);
  if (next < 0 || has_wish) return std::nullopt;
  return Foresight{answer, next};
}

bool RebuildSchedule::must_rebuild(std::int64_t step) {
  if (step != check_step_ + kLag) return false;
  wait();
  stop_agreed_ = reduction_.maxima()[4] > 0.0;
  save_agreed_ = reduction_.maxima()[5] > 0.0;
  answer_ = numbers();
  const std::int64_t next = next_check(*answer_);
  if (next < 0) return true;
  interval_ = static_cast<int>(next - step);
  check_step_ = next;
  return false;
}

void RebuildSchedule::rebuilt(std::int64_t step) {
  if (check_step_ < step && check_step_ + kLag > step) {
    is_check_over_ = true;
    return;
  }
  interval_ /= 2;
  check_step_ = std::min(check_from(step + interval_), next_look(step));
}

RebuildSchedule::PendingLook RebuildSchedule::pending_look(std::int64_t step) {
  if (check_step_ >= step || !is_look(check_step_)) return {};
  reduction_.wait();
  const CheckNumbers answer = numbers();
  return {check_step_, answer.outside, answer.overlap};
}

void RebuildSchedule::restore(std::int64_t step, const PendingLook& look,
                              std::int64_t num_particles) {
  rebuilt(step);
  if (look.step < 0) return;
  check_step_ = look.step;
  begin_check({0.0, 0.0, look.outside, look.overlap, num_particles, {}, 0.0}, {});
  is_check_over_ = true;
}

}  // namespace barchan
