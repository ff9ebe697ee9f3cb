#include <barchan/tasks/halo_watch.hpp>

#include <utility>

#include <barchan/comm/base/watchdog.hpp>

namespace barchan {

template <int Dim>
HaloWatch<Dim>::HaloWatch(Strip<Dim>& strip, StepClock& clock, Progress progress,
                          std::function<void(Side)> tell_arrival)
    : strip_(strip), clock_(clock), tell_arrival_(std::move(tell_arrival)) {
  if (progress == Progress::Thread && strip_.exchange() != nullptr)
    driver_ = std::make_unique<ProgressThread>([this] { drive(); }, guard_);
}

template <int Dim>
void HaloWatch<Dim>::begin_run() {
  lanes_in_chunks_ = strip_.num_lanes();
  left_is_done_ = false;
  for (const Side side : kSides) is_in_[index_of(side)] = !strip_.awaits(side);
}

template <int Dim>
bool HaloWatch<Dim>::may_poll(Side side) const {
  return side == Side::Left || strip_.scheme() == CutScheme::BothSides ||
         !strip_.neighbours().has(Side::Left) || left_is_done_;
}

template <int Dim>
void HaloWatch<Dim>::poll_sides() {
  for (const Side side : kSides) {
    if (!is_in(side) && may_poll(side) && strip_.poll(side)) notice(side);
  }
}

template <int Dim>
void HaloWatch<Dim>::notice(Side side) {
  clock_.noticed(side, strip_.posted_at(side), is_in(opposite(side)));
  is_in_[index_of(side)] = true;
  tell_arrival_(side);
}

/// On the progress thread. What it finds stays found until a worker looks.
/// @pre guard_ is held
template <int Dim>
void HaloWatch<Dim>::drive() {
  Exchange& exchange = *strip_.exchange();
  if (exchange.is_blocking()) return;
  exchange.progress();
  for (const Side side : kSides) {
    if (!is_in(side) && may_poll(side)) (void)exchange.poll(side);
  }
}

/// In the midst of a lane's chunks: somebody waits, or messages need it to come.
template <int Dim>
bool HaloWatch<Dim>::is_poll_of_use() const {
  return lanes_in_chunks_ < strip_.num_lanes() || strip_.exchange()->needs_progress();
}

template <int Dim>
void HaloWatch<Dim>::after_chunk(int lane, bool is_last_of_lane, std::int64_t now) {
  if (strip_.exchange() == nullptr) return;
  if (is_last_of_lane || is_poll_of_use()) try_poll(now);
  if (!is_last_of_lane) return;
  clock_.chunks_end(lane);
  --lanes_in_chunks_;
}

template <int Dim>
void HaloWatch<Dim>::try_poll(std::int64_t begin) {
  const bool all_is_in = all_are_in();
  if (all_is_in && (driver_ || !strip_.exchange()->needs_progress())) return;
  const std::unique_lock<std::mutex> lock(guard_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  const std::array<bool, 2> before{is_in_[0], is_in_[1]};
  if (all_is_in)
    strip_.exchange()->progress();
  else
    poll_sides();
  clock_.polled(begin, {is_in_[0] != before[0], is_in_[1] != before[1]});
}

template <int Dim>
void HaloWatch<Dim>::await(bool left_only) {
  const auto is_over = [this, left_only] { return left_only ? is_in(Side::Left) : all_are_in(); };
  if (is_over()) return;
  const StepClock::Instant begin = clock_.instant();
  {
    const std::lock_guard<std::mutex> lock(guard_);
    clock_.begin_wait(begin);
  }
  wait_until(
      [&] {
        const std::unique_lock<std::mutex> lock(guard_, std::try_to_lock);
        if (lock.owns_lock()) poll_sides();
        return lock.owns_lock() && is_over();
      },
      [this] { return name_of_missing(); });
  const StepClock::Instant end = clock_.instant();
  const std::lock_guard<std::mutex> lock(guard_);
  clock_.end_wait(begin, end);
}

template <int Dim>
std::string HaloWatch<Dim>::name_of_missing() const {
  if (is_in(Side::Left) || is_in(Side::Right))
    return strip_.name_of_halo(is_in(Side::Left) ? Side::Right : Side::Left);
  return strip_.name_of_halo(Side::Left) + ", and " + strip_.name_of_halo(Side::Right);
}

template class HaloWatch<2>;
template class HaloWatch<3>;

}  // namespace barchan
