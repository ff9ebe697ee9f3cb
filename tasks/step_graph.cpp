#include <barchan/tasks/step_graph.hpp>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include <tbb/parallel_for.h>

#include <barchan/comm/clock.hpp>
#include <barchan/tasks/thread_order.hpp>

// The nodes of a step and what precedes what; its messages are in step_graph_messages.cpp.

namespace barchan {
namespace {

constexpr double kSecond = 1e-9;  // in nanoseconds

/// The edge from who starts a step to all of its tasks, which look for their own edges behind it.
const char begin_of_step = 0;

/// A function for every lane. Nothing is read before the thread has taken it up.
struct LaneTasks {
  const std::function<void(int)>& body;
  char end = 0;  ///< its address is the edge to who waits for all lanes

  void operator()(int l) const {
    const TaskOrder order(this, &end);
    body(l);
  }
};

}  // namespace

template <int Dim>
StepGraph<Dim>::StepGraph(Strip<Dim>& strip, const RunOptions& options)
    : strip_(strip),
      schedule_(options.schedule),
      workers_(tbb::global_control::max_allowed_parallelism,
               static_cast<std::size_t>(options.threads)),
      arena_(options.threads),
      max_task_delay_(options.max_delay_seconds),
      delay_state_(options.delay_seed * 2 + 1) {
  arena_.execute([this] { build(); });
  if (options.progress == Progress::Thread && strip_.exchange() != nullptr)
    driver_ = std::make_unique<ProgressThread>([this] { drive(); }, comm_mutex_);
}

template <int Dim>
bool StepGraph<Dim>::has_band(int lane, Side side) const {
  return strip_.lane(lane).band(in_core<Dim>(side)).exists;
}

template <int Dim>
void StepGraph<Dim>::build() {
  graph_ = std::make_unique<tbb::flow::graph>();
  for (int l = 0; l < strip_.num_lanes(); ++l) {
    LaneNodes& n = nodes_.emplace_back();
    n.chunk = std::make_unique<Node>(*graph_, tbb::flow::unlimited, [this, l](int chunk) {
      tell_acquire(&begin_of_step);
      run_chunk(l, chunk);
    });
    n.band = std::make_unique<Node>(*graph_, tbb::flow::unlimited, [this, l](int side) {
      tell_acquire(&begin_of_step);
      run_band(l, static_cast<Side>(side));
    });
  }
  drain_ = std::make_unique<Node>(*graph_, tbb::flow::unlimited, [this](int) {
    tell_acquire(&begin_of_step);
    const TaskOrder order(drain_.get(), graph_.get());
    drain(strip_.num_lanes() == 1 && !arrived_[0]);
  });
}

template <int Dim>
void StepGraph<Dim>::run(const StepFrame& frame, int num_steps) {
  const std::int64_t begin = now_ns();
  frame_ = frame;
  num_steps_ = num_steps;
  arena_.execute([this] {
    lanes_left_ = strip_.num_lanes();
    drain_begin_ = 0;
    for (LaneNodes& n : nodes_) {
      n.idle_since = 0;
      n.step = 0;
      for (auto& sides : n.missing) {
        for (auto& missing : sides) missing = kBandSignals;
      }
    }
    left_is_done_ = false;
    for (const Side side : kSides) arrived_[index_of(side)] = !strip_.awaits(side);
    const ProgressThread::Shift shift(driver_.get());
    if (schedule_ == Schedule::Sequential) await_all();
    tell_release(&begin_of_step);
    for (int l = 0; l < strip_.num_lanes(); ++l) {
      for (const Side side : kSides) {
        if (has_band(l, side) && (!strip_.is_outer(l, side) || arrived_[index_of(side)]))
          signal(l, side, 0);
      }
    }
    for (int l = 0; l < strip_.num_lanes(); ++l) put(*nodes_[static_cast<std::size_t>(l)].chunk, 0);
    graph_->wait_for_all();
    tell_acquire(graph_.get());
  });
  end_step();
  run_ns_ += now_ns() - begin;
}

template <int Dim>
void StepGraph<Dim>::end_step() {
  require_all_bands();
  strip_.end_step();
  sent_at_ = next_sent_at_;
  next_sent_at_ = 0;
  if (trace_ == nullptr) return;
  const std::int64_t exposed = send_ns_ + poll_ns_ + wait_ns_, now = now_ns();
  trace_->count(Trace::Counter::ExposedMicroseconds,
                (exposed - exposed_before_) / strip_.num_lanes(), now);
  trace_->count(Trace::Counter::FlightMicroseconds, flight_ns_ - flight_before_, now);
  exposed_before_ = exposed;
  flight_before_ = flight_ns_;
}

/// A band that nobody did would be a wrong step without a word.
template <int Dim>
void StepGraph<Dim>::require_all_bands() {
  int num_bands = 0;
  bool is_stopped = false;
  for (int l = 0; l < strip_.num_lanes(); ++l) {
    for (const Side side : kSides) num_bands += has_band(l, side) ? num_steps_ : 0;
    is_stopped = is_stopped || strip_.lane(l).must_stop();
  }
  const int done = bands_done_.exchange(0);
  if (done == num_bands || is_stopped) return;
  throw std::logic_error("step graph: " + std::to_string(done) + " of " +
                         std::to_string(num_bands) + " bands were done");
}

template <int Dim>
StepTimes StepGraph<Dim>::times() const {
  const double share = kSecond / strip_.num_lanes();
  StepTimes times;
  std::int64_t chunks = 0, bands = 0;
  for (const LaneNodes& n : nodes_) {
    chunks += n.chunk_ns;
    bands += n.band_ns;
  }
  times.chunks = share * static_cast<double>(chunks);
  times.bands = share * static_cast<double>(bands - send_ns_);
  times.send = share * static_cast<double>(send_ns_);
  times.poll = share * static_cast<double>(poll_ns_);
  times.wait = share * static_cast<double>(wait_ns_);
  times.late = share * static_cast<double>(late_ns_);
  times.run = kSecond * static_cast<double>(run_ns_);
  times.in_flight = kSecond * static_cast<double>(flight_ns_);
  return times;
}

template <int Dim>
GraphShape StepGraph<Dim>::shape() const {
  GraphShape shape;
  for (int l = 0; l < strip_.num_lanes(); ++l) {
    shape.lanes.push_back({strip_.lane(l).num_chunks(), has_band(l, Side::Left),
                           has_band(l, Side::Right), strip_.is_outer(l, Side::Left),
                           strip_.is_outer(l, Side::Right)});
  }
  shape.neighbours = strip_.neighbours();
  shape.is_sequential = schedule_ == Schedule::Sequential;
  return shape;
}

template <int Dim>
void StepGraph<Dim>::run_chunk(int l, int chunk) {
  LaneNodes& nodes = nodes_[static_cast<std::size_t>(l)];
  const TaskOrder order(nodes.chunk.get(), graph_.get());
  const std::int64_t begin = now_ns();
  Lane<Dim>& lane = strip_.lane(l);
  maybe_delay();
  if (chunk == 0) {
    StepFrame frame = frame_;
    frame.step += nodes.step;
    lane.begin_step(frame);
  }
  lane.run_chunk(chunk);
  const std::int64_t end = now_ns();
  nodes.chunk_ns += end - begin;
  if (trace_ != nullptr) trace_->slice(Trace::Slice::Chunk, l, begin, end, nodes.step);
  const bool is_last_chunk = chunk + 1 == lane.num_chunks();
  if (is_last_chunk || is_poll_of_use()) try_poll(end);
  if (!is_last_chunk) {
    put(*nodes.chunk, chunk + 1);
    return;
  }
  if (strip_.num_lanes() > 1) nodes.idle_since = now_ns();
  // Counted before its band may start: on another worker the band looks whether it is the last.
  const bool band_drains = strip_.num_lanes() == 1 && has_band(l, Side::Left) && arrived_[0];
  const bool is_last = lanes_left_.fetch_sub(1) == 1;
  const int step = nodes.step;  // bands may end it
  if (has_band(l, Side::Left) || has_band(l, Side::Right))
    signal(l, has_band(l, Side::Left) ? Side::Left : Side::Right, step);
  else
    end_step(l);
  if (is_last && !band_drains && !(arrived_[0] && arrived_[1])) put(*drain_, 0);
}

template <int Dim>
void StepGraph<Dim>::run_band(int l, Side side) {
  LaneNodes& nodes = nodes_[static_cast<std::size_t>(l)];
  const TaskOrder order(nodes.band.get(), graph_.get());
  const std::int64_t begin = now_ns();
  maybe_delay();
  {
    std::unique_lock<std::mutex> lock(comm_mutex_, std::defer_lock);
    const bool is_remote = strip_.is_remote(l, side);
    if (is_remote) lock.lock();
    strip_.finish_band(l, side);
    send(l, side);
    if (is_remote && side == Side::Left) left_is_done_ = true;
  }
  const std::int64_t end = now_ns();
  ++bands_done_;
  nodes.band_ns += end - begin;
  busy_ns_ += end - begin;
  if (trace_ != nullptr)
    trace_->slice(side == Side::Left ? Trace::Slice::LeftBand : Trace::Slice::RightBand, l, begin,
                  end, nodes.step);
  signal_beside(l, side);
  if (side == Side::Left && has_band(l, Side::Right))
    signal(l, Side::Right, nodes.step);
  else
    end_step(l);
  // A lone worker does this band before it waits for the other side; returned forces are not asked
  // for before it.
  const bool is_waited_for =
      strip_.num_lanes() == 1 || (strip_.is_outer(l, side) && strip_.scheme_returns());
  if (side == Side::Left && is_waited_for && lanes_left_ == 0 && !(arrived_[0] && arrived_[1]))
    put(*drain_, 0);
}

/// @param step  of the run
template <int Dim>
void StepGraph<Dim>::signal(int l, Side side, int step) {
  auto& nodes = nodes_[static_cast<std::size_t>(l)];
  auto& missing = nodes.missing[static_cast<std::size_t>(step % 2)][index_of(side)];
  if (missing.fetch_sub(1) > 1) return;
  missing = kBandSignals;
  put(*nodes.band, static_cast<int>(side));
}

/// What this band wrote lets the band beyond the cut do its next step.
template <int Dim>
void StepGraph<Dim>::signal_beside(int l, Side side) {
  const int next = nodes_[static_cast<std::size_t>(l)].step + 1;
  if (next < num_steps_) signal(strip_.lane_beside(l, side), opposite(side), next);
}

template <int Dim>
void StepGraph<Dim>::end_step(int l) {
  LaneNodes& nodes = nodes_[static_cast<std::size_t>(l)];
  strip_.end_step(l);
  if (++nodes.step < num_steps_ && !strip_.lane(l).must_stop()) put(*nodes.chunk, 0);
}

template <int Dim>
void StepGraph<Dim>::maybe_delay() {
  if (max_task_delay_ <= 0.0) return;
  std::uint64_t s = delay_state_.fetch_add(0x9e3779b97f4a7c15U) + 0x9e3779b97f4a7c15U;
  s = (s ^ (s >> 30)) * 0xbf58476d1ce4e5b9U;
  s = (s ^ (s >> 27)) * 0x94d049bb133111ebU;
  if ((s & 7U) != 0) return;  // one task in eight
  std::this_thread::sleep_for(
      std::chrono::duration<double>(max_task_delay_ * static_cast<double>(s >> 40) * 0x1p-24));
}

template <int Dim>
void StepGraph<Dim>::for_each_lane(const std::function<void(int)>& body) {
  if (strip_.num_lanes() == 1) return body(0);
  arena_.execute([&] {
    const LaneTasks tasks{body};
    tell_release(&tasks);
    tbb::parallel_for(0, strip_.num_lanes(), tasks, tbb::simple_partitioner());
    tell_acquire(&tasks.end);
  });
}

template class StepGraph<2>;
template class StepGraph<3>;

}  // namespace barchan
