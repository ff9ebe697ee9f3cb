#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include <tbb/flow_graph.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <barchan/core/lane.hpp>
#include <barchan/tasks/graph_dot.hpp>
#include <barchan/tasks/progress_thread.hpp>
#include <barchan/tasks/run_options.hpp>
#include <barchan/tasks/strip.hpp>
#include <barchan/tasks/trace.hpp>

namespace barchan {

/// Where the time of one rank's steps went [s]. All but in_flight are a worker's, averaged over the
/// workers.
struct StepTimes {
  double chunks = 0.0;     ///< narrow phase, forces and rows of the interior
  double bands = 0.0;      ///< pairs and rows along the cuts, packing
  double send = 0.0;       ///< inside the exchange, sending: where that waits, this is waiting
  double poll = 0.0;       ///< inside the exchange, polling between chunks
  double wait = 0.0;       ///< idle, waiting for a halo
  double late = 0.0;       ///< of wait: until a neighbour on this node had sent
  double run = 0.0;        ///< in StepGraph::run
  double in_flight = 0.0;  ///< from sending the halo until the neighbours' halo was noticed

  /// The time that communication adds to the step.
  [[nodiscard]] double exposed() const { return send + poll + wait; }
};

/// One time step as a graph, built once:
///
///     begin ─► chunk(l) ─► chunk(l) ─► … ─► left(l) ─► right(l) ─► end        for every lane l
///                 │                            ▲          ▲
///                 │ polls                      │          │
///                 ├───────► arrived(Left) ─────┘          │        the outer lanes of the strip
///                 └───────► arrived(Right) ───────────────┘
///
///   chunk(l, c)       precedes chunk(l, c+1); the last one precedes left(l)
///   left(l)           precedes right(l): two workers never work on one lane at a time
///   arrived(side)     precedes left or right of the lane at that end of the strip;
///                     the lanes' other cuts are in memory
///   left, right(l)    of step k precede the sends of step k+1's halo,
///                     which is in flight behind the chunks of step k+1
///
/// A chunk that ends polls the exchange under a try-lock. When both halos are in, it still lets the
/// exchange advance, since neighbours may wait for the rest of what this rank sent. Where messages
/// arrive without polls, workers do not poll while every lane has chunks left. When no chunk is
/// left, one drain node polls until both halos are in; a lone worker leaves it for the left band as
/// soon as that band can be finished. With Progress::Thread a thread polls all the time, and chunks
/// only read what it found. With Schedule::Sequential the rank waits for the halo before the first
/// chunk: nothing is hidden.
///
/// A rank without neighbours may run several steps at once. A lane then begins its next step when
/// its own is done, and a band waits for the band beside it, one step before, as it does between
/// ranks: a delay of one worker delays the others only if it is longer than a step.
template <int Dim>
class StepGraph {
 public:
  StepGraph(Strip<Dim>& strip, const RunOptions& options);

  /// Steps on all lanes. @return when all lanes are done and the next halo is on its way. A lane
  /// that must_stop() goes no further, nor do others that then wait for it.
  /// @param num_steps  without neighbours any number, else 1
  void run(const StepFrame& frame, int num_steps = 1);
  /// How many of the steps of the last run a lane did.
  [[nodiscard]] int steps_done(int lane) const {
    return nodes_[static_cast<std::size_t>(lane)].step;
  }
  /// Runs a function for every lane on the graph's threads.
  void for_each_lane(const std::function<void(int)>& body);
  [[nodiscard]] StepTimes times() const;
  [[nodiscard]] GraphShape shape() const;
  /// Records tasks and messages from now on. @param trace  lives longer; null: stop recording
  void set_trace(Trace* trace) { trace_ = trace; }

 private:
  using Signal = tbb::flow::continue_msg;
  using Node = tbb::flow::function_node<int, Signal>;
  static constexpr int kBandSignals = 2;  ///< a band waits for the work before it and its ghosts
  struct LaneNodes {
    std::unique_ptr<Node> chunk, band;  ///< of a chunk, of a side
    int step = 0;                       ///< of the run
    /// Signals that a band lacks, by the step's parity and side: the lane beside may be one ahead.
    std::array<std::array<std::atomic<int>, 2>, 2> missing{};
    std::int64_t chunk_ns = 0, band_ns = 0;
    std::atomic<std::int64_t> idle_since{0};  ///< chunks done, a message missing; 0: not so
  };

  void build();
  void run_chunk(int lane, int chunk);
  void run_band(int lane, Side side);
  void end_step(int lane);
  [[nodiscard]] bool is_poll_of_use() const;
  void try_poll(std::int64_t begin);
  bool poll_sides();
  void drive();
  [[nodiscard]] bool may_poll(Side side) const;
  void signal(int lane, Side side, int step);
  void signal_beside(int lane, Side side);
  void send(int lane, Side side);
  void notice(Side side);
  void drain(bool may_leave);
  void poll_until_in(bool may_leave);
  void await_all();
  void end_step();
  void require_all_bands();
  void maybe_delay();
  [[nodiscard]] bool has_band(int lane, Side side) const;

  Strip<Dim>& strip_;
  Schedule schedule_;
  tbb::global_control workers_;  ///< the requested number, also on a node with fewer cores
  tbb::task_arena arena_;
  std::unique_ptr<tbb::flow::graph> graph_;
  std::unique_ptr<Node> drain_;
  StepFrame frame_;
  int num_steps_ = 1;      ///< of this run
  std::mutex comm_mutex_;  ///< one thread at a time in the exchange
  std::array<std::atomic<bool>, 2> arrived_{};
  std::atomic<int> lanes_left_{0}, bands_done_{0};
  std::atomic<bool> left_is_done_{false};
  std::deque<LaneNodes> nodes_;
  // In nanoseconds. Under comm_mutex_: send, poll, flights; wait is written by one task at a time.
  std::int64_t send_ns_ = 0, poll_ns_ = 0, wait_ns_ = 0, flight_ns_ = 0;
  std::int64_t late_ns_ = 0;
  std::int64_t run_ns_ = 0;               ///< in run()
  std::atomic<std::int64_t> busy_ns_{0};  ///< in bands; a wait counts those idle only
  std::int64_t drain_begin_ = 0;
  std::int64_t posted_at_ = 0;  ///< the last that came while the drain waited, by its sender
  std::int64_t sent_at_ = 0,
               next_sent_at_ = 0;  ///< first send of this step's halo, of the next one's
  std::int64_t exposed_before_ = 0, flight_before_ = 0;
  Trace* trace_ = nullptr;
  double max_task_delay_;
  std::atomic<std::uint64_t> delay_state_;
  std::unique_ptr<ProgressThread> driver_;  ///< last: it ends first; null: workers poll
};

extern template class StepGraph<2>;
extern template class StepGraph<3>;

}  // namespace barchan
