#include <barchan/tasks/step_graph.hpp>

#include <thread>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <barchan/comm/backoff.hpp>
#include <barchan/comm/watchdog.hpp>

namespace barchan {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::array<Side, 2> kSides{Side::Left, Side::Right};
constexpr std::size_t at(Side side) { return static_cast<std::size_t>(side); }

double seconds(Clock::time_point from, Clock::time_point to) { return std::chrono::duration<double>(to - from).count(); }

}  // namespace

template <int Dim>
StepGraph<Dim>::StepGraph(Strip<Dim>& strip, int threads, Schedule schedule, double max_task_delay, std::uint64_t delay_seed)
    : strip_(strip), schedule_(schedule), workers_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
      arena_(threads), max_task_delay_(max_task_delay), delay_state_(delay_seed * 2 + 1) {
  arena_.execute([this] { build(); });
}

template <int Dim>
bool StepGraph<Dim>::has_band(int lane, Side side) const {
  return strip_.lane(lane).band(side == Side::Left ? Lane<Dim>::Left : Lane<Dim>::Right).exists;
}

template <int Dim>
void StepGraph<Dim>::build() {
  graph_ = std::make_unique<tbb::flow::graph>();
  for (int l = 0; l < strip_.num_lanes(); ++l) {
    LaneNodes& n = nodes_.emplace_back();
    n.chunk = std::make_unique<ChunkNode>(*graph_, tbb::flow::unlimited, [this, l](int chunk) { run_chunk(l, chunk); });
    // Each waits for two signals: the work before it, and its ghosts.
    n.left = std::make_unique<BandNode>(*graph_, 2, [this, l](Signal) { run_band(l, Side::Left); });
    n.right = std::make_unique<BandNode>(*graph_, 2, [this, l](Signal) { run_band(l, Side::Right); });
  }
  drain_ = std::make_unique<tbb::flow::function_node<int, Signal>>(*graph_, tbb::flow::unlimited, [this](int) { drain(); });
}

template <int Dim>
void StepGraph<Dim>::run(const StepFrame& frame) {
  frame_ = frame;
  arena_.execute([this] {
    lanes_left_ = strip_.num_lanes();
    left_is_done_ = false;
    for (const Side side : kSides) arrived_[at(side)] = !strip_.awaits(side);
    if (schedule_ == Schedule::Sequential) await_all();
    for (int l = 0; l < strip_.num_lanes(); ++l) {
      for (const Side side : kSides) {
        if (has_band(l, side) && (!strip_.is_outer(l, side) || arrived_[at(side)])) signal(l, side);
      }
    }
    for (int l = 0; l < strip_.num_lanes(); ++l) nodes_[static_cast<std::size_t>(l)].chunk->try_put(0);
    graph_->wait_for_all();
  });
  strip_.end_step(true);
  times_.chunks = times_.bands = 0.0;
  for (const LaneNodes& n : nodes_) {
    times_.chunks += n.chunk_seconds;
    times_.bands += n.band_seconds;
  }
  times_.poll = poll_seconds_;
}

template <int Dim>
void StepGraph<Dim>::run_chunk(int l, int chunk) {
  const auto begin = Clock::now();
  Lane<Dim>& lane = strip_.lane(l);
  LaneNodes& nodes = nodes_[static_cast<std::size_t>(l)];
  maybe_delay();
  if (chunk == 0) lane.begin_step(frame_);
  lane.run_chunk(chunk);
  nodes.chunk_seconds += seconds(begin, Clock::now());
  try_poll();
  if (chunk + 1 < lane.num_chunks()) {
    nodes.chunk->try_put(chunk + 1);
    return;
  }
  if (has_band(l, Side::Left)) nodes.left->try_put(Signal());
  else if (has_band(l, Side::Right)) nodes.right->try_put(Signal());
  if (lanes_left_.fetch_sub(1) == 1 && !(arrived_[0] && arrived_[1])) drain_->try_put(0);
}

template <int Dim>
void StepGraph<Dim>::run_band(int l, Side side) {
  const auto begin = Clock::now();
  LaneNodes& nodes = nodes_[static_cast<std::size_t>(l)];
  maybe_delay();
  {
    std::unique_lock<std::mutex> lock(comm_mutex_, std::defer_lock);
    const bool is_outer = strip_.is_outer(l, side);
    if (is_outer) lock.lock();
    strip_.finish_band(l, side);
    strip_.send_band(l, side);
    if (is_outer && side == Side::Left) left_is_done_ = true;
    if (is_outer) sent_ = Clock::now();
  }
  nodes.band_seconds += seconds(begin, Clock::now());
  if (side == Side::Left && has_band(l, Side::Right)) nodes.right->try_put(Signal());
  if (side == Side::Left && strip_.is_outer(l, side) && strip_.scheme_returns() && lanes_left_ == 0 && !arrived_[1]) drain_->try_put(0);
}

template <int Dim>
void StepGraph<Dim>::signal(int l, Side side) {
  auto& nodes = nodes_[static_cast<std::size_t>(l)];
  (side == Side::Left ? nodes.left : nodes.right)->try_put(Signal());
}

template <int Dim>
bool StepGraph<Dim>::may_poll(Side side) const {
  return side == Side::Left || !strip_.scheme_returns() || !strip_.neighbours().has(Side::Left) || left_is_done_;
}

template <int Dim>
bool StepGraph<Dim>::poll_sides() {
  bool all = true;
  for (const Side side : kSides) {
    if (arrived_[at(side)]) continue;
    if (!may_poll(side)) continue;
    if (!strip_.poll(side)) {
      all = false;
      continue;
    }
    arrived_[at(side)] = true;
    if (arrived_[0] && arrived_[1]) times_.in_flight += seconds(sent_, Clock::now());
    if (lanes_left_ >= 0) signal(side == Side::Left ? 0 : strip_.num_lanes() - 1, side);
  }
  return all;
}

template <int Dim>
void StepGraph<Dim>::try_poll() {
  if (arrived_[0] && arrived_[1]) return;
  const std::unique_lock<std::mutex> lock(comm_mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  const auto begin = Clock::now();
  (void)poll_sides();
  poll_seconds_ += seconds(begin, Clock::now());
}

template <int Dim>
void StepGraph<Dim>::drain() {
  const auto begin = Clock::now();
  wait_until(
      [this] {
        const std::unique_lock<std::mutex> lock(comm_mutex_, std::try_to_lock);
        return lock.owns_lock() && poll_sides();
      },
      [this] {
        return fmt::format("halo of this step, from the {}{}{}", arrived_[0] ? "" : "left", arrived_[0] || arrived_[1] ? "" : " and the ",
                           arrived_[1] ? "" : "right");
      });
  times_.exposed += seconds(begin, Clock::now());
}

template <int Dim>
void StepGraph<Dim>::await_all() {
  if (arrived_[0] && arrived_[1]) return;
  lanes_left_ = -1;  // poll_sides must not signal: run() does
  drain();
  lanes_left_ = strip_.num_lanes();
}

template <int Dim>
void StepGraph<Dim>::maybe_delay() {
  if (max_task_delay_ <= 0.0) return;
  std::uint64_t s = delay_state_.fetch_add(0x9e3779b97f4a7c15U) + 0x9e3779b97f4a7c15U;
  s = (s ^ (s >> 30)) * 0xbf58476d1ce4e5b9U;
  s = (s ^ (s >> 27)) * 0x94d049bb133111ebU;
  if ((s & 7U) != 0) return;  // one task in eight
  std::this_thread::sleep_for(std::chrono::duration<double>(max_task_delay_ * static_cast<double>(s >> 40) * 0x1p-24));
}

template <int Dim>
void StepGraph<Dim>::for_each_lane(const std::function<void(int)>& body) {
  if (strip_.num_lanes() == 1) return body(0);
  arena_.execute([&] { tbb::parallel_for(0, strip_.num_lanes(), [&](int l) { body(l); }, tbb::simple_partitioner()); });
}

template class StepGraph<2>;
template class StepGraph<3>;

}  // namespace barchan
