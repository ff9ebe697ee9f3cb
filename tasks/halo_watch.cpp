#include <barchan/tasks/halo_watch.hpp>

#include <utility>

#include <barchan/comm/base/watchdog.hpp>

namespace barchan {

template <int Dim>
HaloWatch<Dim>::HaloWatch(Strip<Dim>& strip, StepClock& clock, Progress progress,
                          std::function<void(int)> tell_arrival)
    : strip_(strip),
      clock_(clock),
      tell_arrival_(std::move(tell_arrival)),
      is_in_(static_cast<std::size_t>(strip.num_links())) {
  found_.reserve(is_in_.size());
  if (progress == Progress::Thread && strip_.exchange() != nullptr)
    driver_ = std::make_unique<ProgressThread>([this] { drive(); }, guard_);
}

template <int Dim>
void HaloWatch<Dim>::begin_run() {
  lanes_in_chunks_ = strip_.num_lanes();
  left_is_done_ = false;
  int missing = 0;
  for (int link = 0; link < strip_.num_links(); ++link) {
    is_in_[static_cast<std::size_t>(link)] = !strip_.awaits(link);
    missing += strip_.awaits(link) ? 1 : 0;
  }
  num_missing_ = missing;
}

/// In the published scheme the right neighbour answers what the left band has made known.
template <int Dim>
bool HaloWatch<Dim>::may_poll(int link) const {
  return strip_.scheme() == CutScheme::BothSides || strip_.end_of(link).side == Side::Left ||
         !strip_.has_left_link() || left_is_done_;
}

template <int Dim>
void HaloWatch<Dim>::poll_links() {
  found_.clear();
  for (int link = 0; link < strip_.num_links(); ++link) {
    if (is_in(link))
      strip_.advance_shadows(link);
    else if (may_poll(link) && strip_.poll(link))
      notice(link);
  }
}

template <int Dim>
void HaloWatch<Dim>::notice(int link) {
  found_.push_back(link);
  is_in_[static_cast<std::size_t>(link)] = true;
  --num_missing_;
  clock_.noticed(link, strip_.end_of(link).lane, strip_.posted_at(link), all_are_in());
  tell_arrival_(link);
}

template <int Dim>
bool HaloWatch<Dim>::left_are_in() const {
  for (int link = 0; link < strip_.num_links(); ++link) {
    if (strip_.end_of(link).side == Side::Left && !is_in(link)) return false;
  }
  return true;
}

/// On the progress thread. What it finds stays found until a worker looks.
/// @pre guard_ is held
template <int Dim>
void HaloWatch<Dim>::drive() {
  Exchange& exchange = *strip_.exchange();
  if (exchange.is_blocking()) return;
  exchange.progress();
  for (int link = 0; link < strip_.num_links(); ++link) {
    if (!is_in(link) && may_poll(link)) (void)exchange.poll(link);
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
  if (all_is_in && !strip_.has_shadows() && (driver_ || !strip_.exchange()->needs_progress()))
    return;
  const std::unique_lock<std::mutex> lock(guard_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  found_.clear();
  const std::int64_t worked = strip_.shadow_ns();
  if (all_is_in)
    strip_.progress();
  else
    poll_links();
  clock_.polled(begin, found_, strip_.shadow_ns() - worked);
}

template <int Dim>
void HaloWatch<Dim>::await(bool left_only) {
  const auto is_over = [this, left_only] { return left_only ? left_are_in() : all_are_in(); };
  if (is_over()) return;
  const StepClock::Instant begin = clock_.instant();
  {
    const std::lock_guard<std::mutex> lock(guard_);
    clock_.begin_wait(begin);
  }
  std::int64_t worked = 0;
  wait_until(
      [&] {
        const std::unique_lock<std::mutex> lock(guard_, std::try_to_lock);
        if (!lock.owns_lock()) return false;
        const std::int64_t before = strip_.shadow_ns();
        poll_links();
        worked += strip_.shadow_ns() - before;
        return is_over();
      },
      [this] { return name_of_missing(); });
  const StepClock::Instant end = clock_.instant();
  const std::lock_guard<std::mutex> lock(guard_);
  clock_.end_wait(begin, end, worked);
}

template <int Dim>
std::string HaloWatch<Dim>::name_of_missing() const {
  std::string names;
  for (int link = 0; link < strip_.num_links(); ++link) {
    if (!is_in(link)) names += (names.empty() ? "" : ", and ") + strip_.name_of_halo(link);
  }
  return names;
}

template class HaloWatch<2>;
template class HaloWatch<3>;

}  // namespace barchan
