#include <barchan/tasks/rebuild_schedule.hpp>

#include <algorithm>

#include <barchan/comm/clock.hpp>

namespace barchan {
namespace {

constexpr std::size_t kMaxima = 6, kSums = 4;

}  // namespace

RebuildSchedule::RebuildSchedule(const Communicator& communicator, double skin, double dt,
                                 double gravity)
    : reduction_(communicator, kMaxima, kSums), skin_(skin), dt_(dt), gravity_(gravity) {}

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

void RebuildSchedule::begin_check(const CheckNumbers& mine, Wishes wishes) {
  is_asked_ = true;
  const double maxima[kMaxima] = {mine.distance,
                                  mine.speed,
                                  static_cast<double>(mine.outside),
                                  mine.overlap,
                                  wishes.stop ? 1.0 : 0.0,
                                  wishes.save ? 1.0 : 0.0};
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
          maxima[3], sums[0],   {sums[1], sums[2], sums[3]}};
}

std::optional<RebuildSchedule::Foresight> RebuildSchedule::foresee() {
  wait();
  const CheckNumbers answer = numbers();
  const int n = next_interval(answer.distance, answer.speed, skin_, dt_, gravity_, interval_);
  const bool has_wish = reduction_.maxima()[4] > 0.0 || reduction_.maxima()[5] > 0.0;
  if (n < 0 || has_wish) return std::nullopt;
  return Foresight{answer, check_step_ + kLag + n};
}

bool RebuildSchedule::must_rebuild(std::int64_t step) {
  if (!is_asked_ || step != check_step_ + kLag) return false;
  wait();
  is_asked_ = false;
  stop_agreed_ = reduction_.maxima()[4] > 0.0;
  save_agreed_ = reduction_.maxima()[5] > 0.0;
  answer_ = numbers();
  const int n = next_interval(answer_->distance, answer_->speed, skin_, dt_, gravity_, interval_);
  if (n < 0) return true;
  interval_ = n;
  check_step_ = step + n;
  return false;
}

void RebuildSchedule::rebuilt(std::int64_t step) {
  // A check under way, or due now, goes on: without the speeds that it finds nobody knows how long
  // the next lists serve. Its distance is that of lists before these, and so never too small.
  if (is_asked_ || check_step_ == step) return;
  interval_ = std::max(interval_ / 2, 1);
  check_step_ = step + interval_;
}

RebuildSchedule::State RebuildSchedule::state(std::int64_t step) {
  State s{check_step_, interval_, check_step_ < step, {}, 0};
  if (!s.has_check) return s;
  reduction_.wait();
  std::copy_n(reduction_.maxima().begin(), s.check.size(), s.check.begin());
  s.num_particles = reduction_.sums()[0];
  return s;
}

void RebuildSchedule::restore(const State& state, bool is_root) {
  check_step_ = state.check_step;
  interval_ = state.interval;
  if (!state.has_check) return;
  begin_check({state.check[0],
               state.check[1],
               static_cast<std::int64_t>(state.check[2]),
               state.check[3],
               is_root ? state.num_particles : 0,
               {}},
              {});
}

}  // namespace barchan
