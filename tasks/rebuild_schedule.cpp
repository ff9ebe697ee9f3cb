#include <barchan/tasks/rebuild_schedule.hpp>

#include <algorithm>
#include <cmath>

#include <barchan/core/base/clock.hpp>

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
                                 double gravity, int look_every, int lag)
    : is_root_(communicator.is_root()),
      reduction_(communicator, kMaxima, kSums),
      skin_(skin),
      dt_(dt),
      gravity_(gravity),
      look_every_(look_every),
      lag_(lag),
      lists_end_(end_of_lists(0, 0.0, 0.0, 0)) {}

std::int64_t RebuildSchedule::end_of_lists(std::int64_t from, double distance, double speed,
                                           std::int64_t speed_step) const {
  constexpr double kMost = 1e9;
  const double room = 0.5 * skin_ - distance, a = gravity_ * dt_ * dt_;
  const double b = 2.0 * speed * dt_ + a * static_cast<double>(from - speed_step);
  const double n = 2.0 * room / (b + std::sqrt(b * b + 4.0 * a * room));
  return from + 1 + (n > 0.0 ? static_cast<std::int64_t>(std::min(n, kMost)) : 0);  // NaN: none
}

std::int64_t RebuildSchedule::check_in(std::int64_t first, std::int64_t wanted,
                                       std::int64_t lists_end) const {
  const std::int64_t look = next_look(first);
  std::int64_t check = std::min(check_from(wanted), look);
  while (check > first && check + lag_ > lists_end) check -= kCheckEvery;
  return check + lag_ <= look ? check : look;  // no look waits for another answer
}

RebuildSchedule::Outlook RebuildSchedule::outlook(const CheckNumbers& answer,
                                                  std::int64_t answer_step) const {
  const std::int64_t end =
      is_check_over_ ? end_of_lists(lists_step_, 0.0, answer.speed, check_step_)
                     : end_of_lists(check_step_, answer.distance, answer.speed, check_step_);
  return {end, check_in(answer_step, answer_step + std::max(2 * interval_, 1), end)};
}

void RebuildSchedule::begin_check(const CheckNumbers& mine, Wishes wishes) {
  is_check_over_ = false;
  check_skin_ = skin_;
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
  wait_seconds_ += seconds_since(begin);
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
  const Outlook next = outlook(answer, check_step_ + lag_);
  const bool has_wish = reduction_.maxima()[4] > 0.0 || reduction_.maxima()[5] > 0.0 ||
                        (answer.skin > 0.0 && answer.skin != skin_);
  if (next.lists_end < next.next_check + lag_ || has_wish) return std::nullopt;
  return Foresight{answer, next.next_check};
}

bool RebuildSchedule::must_rebuild(std::int64_t step) {
  // After a restart with a shorter lag the answer may be overdue.
  if (step < check_step_ + lag_) return step >= lists_end_;
  wait();
  stop_agreed_ = reduction_.maxima()[4] > 0.0;
  save_agreed_ = reduction_.maxima()[5] > 0.0;
  answer_ = numbers();
  // Of lists before these, which may have had a larger skin.
  if (is_check_over_ && answer_->distance <= 0.5 * check_skin_)
    answer_->distance = std::min(answer_->distance, 0.5 * skin_);
  const Outlook next = outlook(*answer_, step);
  speed_ = answer_->speed;
  speed_step_ = check_step_;
  lists_end_ = next.lists_end;
  interval_ = static_cast<int>(next.next_check - step);
  check_step_ = next.next_check;
  return step >= lists_end_;
}

void RebuildSchedule::rebuilt(std::int64_t step) {
  lists_step_ = step;
  lists_end_ = end_of_lists(step, 0.0, speed_, speed_step_);
  if (check_step_ < step && check_step_ + lag_ >= step) {
    is_check_over_ = true;
    return;
  }
  interval_ /= 2;
  check_step_ = check_in(check_from(step), step + interval_, lists_end_);
}

void RebuildSchedule::begin(std::int64_t step, double speed) {
  speed_ = speed;
  speed_step_ = step;
  rebuilt(step);
}

PendingLook RebuildSchedule::pending_look(std::int64_t step) {
  if (check_step_ >= step || !is_look(check_step_)) return {};
  reduction_.wait();
  const CheckNumbers answer = numbers();
  return {check_step_, answer.outside, answer.overlap};
}

void RebuildSchedule::restore(std::int64_t step, double speed, const PendingLook& look,
                              std::int64_t num_particles) {
  begin(step, speed);
  if (look.step < 0) return;
  check_step_ = look.step;
  begin_check({0.0, speed, look.outside, look.overlap, num_particles, {}, 0.0}, {});
  is_check_over_ = true;
}

RebuildSchedule::Memory RebuildSchedule::memory(std::int64_t step) {
  Memory m{skin_,      dt_,         gravity_,  speed_,         speed_step_, lists_step_,
           lists_end_, check_step_, interval_, is_check_over_, std::nullopt};
  if (check_step_ >= step) return m;
  wait();
  m.check = numbers();
  return m;
}

void RebuildSchedule::recall(std::int64_t step, const Memory& m) {
  if (check_step_ < step) wait();
  skin_ = m.skin;
  dt_ = m.dt;
  gravity_ = m.gravity;
  speed_ = m.speed;
  speed_step_ = m.speed_step;
  lists_step_ = m.lists_step;
  lists_end_ = m.lists_end;
  check_step_ = m.check_step;
  interval_ = m.interval;
  answer_.reset();
  stop_agreed_ = save_agreed_ = false;
  if (m.check) {
    CheckNumbers mine = *m.check;  // of all ranks: the largest of equals, and one rank's sums
    if (!is_root_) mine.particles = 0, mine.imbalance = {};
    begin_check(mine, {});
  }
  is_check_over_ = m.is_check_over;
}

void RebuildSchedule::amend(std::int64_t step, std::int64_t newcomers, double speed) {
  Memory m = memory(step);
  m.speed = std::max(m.speed, speed);
  if (m.check) {
    m.check->particles += newcomers;
    m.check->speed = std::max(m.check->speed, speed);
  }
  recall(step, m);
}

}  // namespace barchan
