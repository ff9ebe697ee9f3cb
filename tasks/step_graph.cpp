#include <barchan/tasks/step_graph.hpp>

#include <chrono>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include <barchan/core/base/clock.hpp>
#include <barchan/core/base/random.hpp>
#include <barchan/core/brick/diagnose.hpp>

namespace barchan {
namespace {

template <int Dim>
GraphShape shape_of(const Strip<Dim>& strip, Schedule schedule) {
  GraphShape shape = graph_shape(strip.form(), strip.ties());
  shape.is_sequential = schedule == Schedule::Sequential;
  shape.scheme = strip.scheme();
  return shape;
}

}  // namespace

template <int Dim>
StepGraph<Dim>::StepGraph(Strip<Dim>& strip, const RunOptions& options)
    : strip_(strip),
      clock_(strip.num_lanes(), strip.has_shadows()),
      shape_(shape_of(strip, options.schedule)),
      steps_(static_cast<std::size_t>(strip.num_lanes())),
      delays_(options.hooks),
      graph_(step_tasks(shape_), options.threads,
             [this](const StepTask& task, int parity) { do_task(task, parity); }),
      awaits_right_(graph_.list().find({Work::AwaitRight}) >= 0),
      begin_(graph_.list().find({Work::Begin})),
      watch_(strip, clock_, options.progress,
             [this](int link) { graph_.put(arrived_[static_cast<std::size_t>(link)], parity_); }) {
  for (int l = 0; l < strip.num_lanes(); ++l)
    chunks_.push_back(graph_.list().find({Work::Chunks, l}));
  for (int link = 0; link < strip.num_links(); ++link)
    arrived_.push_back(graph_.list().find({Work::Arrived, link}));
}

template <int Dim>
GraphShape StepGraph<Dim>::shape() const {
  GraphShape shape = shape_;
  for (int l = 0; l < shape.num_lanes(); ++l)
    shape.lanes[static_cast<std::size_t>(l)].num_chunks = strip_.lane(l).brick.num_chunks();
  return shape;
}

template <int Dim>
void StepGraph<Dim>::run(const StepFrame& frame, int num_steps) {
  const std::int64_t begun = now_ns();
  frame_ = frame;
  num_steps_ = num_steps;
  strip_.begin_step(frame);
  steps_.assign(steps_.size(), 0);
  clock_.begin_run();
  watch_.begin_run();
  {
    const auto shift = watch_.shift();
    graph_.run([this] { begin(); });
  }
  require_all_steps();
  parity_ = (parity_ + num_steps) % 2;
  strip_.end_step();
  clock_.end_run(begun);
}

/// Ghosts that a rebuild has brought need no message.
template <int Dim>
void StepGraph<Dim>::begin() {
  for (int link = 0; link < strip_.num_links(); ++link) {
    if (watch_.is_in(link)) graph_.put(arrived_[static_cast<std::size_t>(link)], parity_);
  }
  graph_.put(begin_, parity_);
}

template <int Dim>
void StepGraph<Dim>::do_task(const StepTask& task, int parity) {
  switch (task.work) {
    case Work::Chunks:
      run_chunks(task.lane);
      break;
    case Work::LeftBand:
      finish_band(task.lane, Side::Left);
      break;
    case Work::RightBand:
      finish_band(task.lane, Side::Right);
      break;
    case Work::Await:
      return watch_.await(awaits_right_);
    case Work::AwaitRight:
      return watch_.await(false);
    default:
      return;  // messages, and who waits
  }
  if (task.work == shape_.last_work(task.lane)) end_step(task.lane, parity);
}

template <int Dim>
void StepGraph<Dim>::run_chunks(int l) {
  Lane<Dim>& lane = strip_.lane(l);
  StepFrame frame = frame_;
  frame.step += steps_done(l);
  const int num_chunks = lane.brick.num_chunks();
  for (int c = 0; c < num_chunks; ++c) {
    const std::int64_t begin = now_ns();
    maybe_delay();
    if (c == 0) lane.step.begin(frame);
    lane.step.run_chunk(c);
    const std::int64_t end = now_ns();
    clock_.chunk(l, steps_done(l), begin, end);
    watch_.after_chunk(l, c + 1 == num_chunks, end);
  }
}

template <int Dim>
void StepGraph<Dim>::finish_band(int l, Side side) {
  const std::int64_t begin = now_ns();
  maybe_delay();
  {
    // Pairs need no exchange, but for the answer to them.
    std::unique_lock<std::mutex> lock(watch_.guard(), std::defer_lock);
    const bool is_remote = shape_.is_remote(l, side);
    if (is_remote) lock.lock();
    strip_.take_halos(l, side);
    if (is_remote && !shape_.returns()) lock.unlock();
    strip_.finish_band(l, side);
    if (is_remote && !shape_.returns()) lock.lock();
    send(l, side);
    if (is_remote && side == Side::Left) watch_.left_band_is_done();
  }
  clock_.band(l, side, steps_done(l), begin, now_ns());
}

/// @pre the exchange is guarded for a band that another rank waits for
template <int Dim>
void StepGraph<Dim>::send(int l, Side side) {
  const std::vector<LaneTie>& ties = strip_.ties(l);
  for (int tie = 0; tie < static_cast<int>(ties.size()); ++tie) {
    const LaneTie& to = ties[static_cast<std::size_t>(tie)];
    if (shape_.sending_band(to) != side) continue;
    const std::int64_t in_exchange = strip_.send_ns(), begin = now_ns();
    strip_.send_halo(l, tie);
    if (to.link < 0) continue;
    clock_.sent(to.link, {begin, strip_.sent_at(), now_ns()}, strip_.send_ns() - in_exchange);
  }
}

/// In the last task of the lane, which precedes its next one.
template <int Dim>
void StepGraph<Dim>::end_step(int l, int parity) {
  strip_.end_step(l);
  const bool goes_on = ++steps_[static_cast<std::size_t>(l)] < num_steps_;
  if (goes_on && !must_stop(strip_.lane(l).brick))
    graph_.put(chunks_[static_cast<std::size_t>(l)], 1 - parity);
}

/// A step that a lane did not come to would be a wrong state without a word.
template <int Dim>
void StepGraph<Dim>::require_all_steps() const {
  bool all_done = true, is_stopped = false;
  for (int l = 0; l < strip_.num_lanes(); ++l) {
    all_done = all_done && steps_done(l) == num_steps_;
    is_stopped = is_stopped || must_stop(strip_.lane(l).brick);
  }
  if (!all_done && !is_stopped) throw std::logic_error("step graph: a lane did not end its steps");
}

template <int Dim>
void StepGraph<Dim>::maybe_delay() {
  if (delays_.max_delay_seconds <= 0.0) return;
  CounterRandom random(delays_.delay_seed, ++num_delays_);
  if (random.bits() % 8 != 0) return;  // one task in eight
  std::this_thread::sleep_for(
      std::chrono::duration<double>(random.uniform(0.0, delays_.max_delay_seconds)));
}

template <int Dim>
void StepGraph<Dim>::for_each_lane(const std::function<void(int)>& body) {
  if (strip_.num_lanes() == 1) return body(0);
  graph_.for_each(strip_.num_lanes(), body);
}

template class StepGraph<2>;
template class StepGraph<3>;

}  // namespace barchan
