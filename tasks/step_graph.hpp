#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include <tbb/flow_graph.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <barchan/core/lane.hpp>
#include <barchan/tasks/run_options.hpp>
#include <barchan/tasks/strip.hpp>

namespace barchan {

/// Seconds of one rank's steps.
struct StepTimes {
  double chunks = 0.0;     ///< narrow phase, forces and rows of the interior, over all workers
  double bands = 0.0;      ///< pairs and rows along the cuts, packing and sending
  double poll = 0.0;       ///< asking for messages between chunks
  double exposed = 0.0;    ///< waiting for messages with nothing else to do
  double in_flight = 0.0;  ///< from sending the halo until the neighbours' halo was noticed
};

/// One time step as a graph, built once:
///
///     begin ─► chunk(l) ─► chunk(l) ─► … ─► left(l) ─► right(l) ─► end        for every lane l
///                │ polls                      ▲           ▲
///                └────────► arrived(Left) ────┘           │
///                           arrived(Right) ───────────────┘
///
///   chunk(l, c)      precedes chunk(l, c+1); the last one precedes left(l)
///   left(l)          precedes right(l): a lane is never worked on twice at a time
///   arrived(side)    precedes left/right of the lane at that end of the strip; the other cuts are in memory
///   left/right(l)    of step k precede the sends of step k+1's halo, which fly behind the chunks of step k+1
///
/// A chunk that ends polls the exchange under a try-lock. When no chunk is left, one drain node polls until all is in.
/// With Schedule::Sequential the halo is waited for before the first chunk: nothing is hidden.
template <int Dim>
class StepGraph {
 public:
  StepGraph(Strip<Dim>& strip, int threads, Schedule schedule, double max_task_delay, std::uint64_t delay_seed);

  /// One step on all lanes. @return when all lanes are done and the next halo is on its way
  void run(const StepFrame& frame);
  /// Runs a function for every lane on the graph's threads.
  void for_each_lane(const std::function<void(int)>& body);
  [[nodiscard]] const StepTimes& times() const { return times_; }

 private:
  using Signal = tbb::flow::continue_msg;
  using ChunkNode = tbb::flow::function_node<int, Signal>;
  using BandNode = tbb::flow::continue_node<Signal>;
  using Clock = std::chrono::steady_clock;
  struct LaneNodes {
    std::unique_ptr<ChunkNode> chunk;
    std::unique_ptr<BandNode> left, right;
    double chunk_seconds = 0.0, band_seconds = 0.0;
  };

  void build();
  void run_chunk(int lane, int chunk);
  void run_band(int lane, Side side);
  void try_poll();
  bool poll_sides();
  [[nodiscard]] bool may_poll(Side side) const;
  void signal(int lane, Side side);
  void drain();
  void await_all();
  void maybe_delay();
  [[nodiscard]] bool has_band(int lane, Side side) const;

  Strip<Dim>& strip_;
  Schedule schedule_;
  tbb::global_control workers_;  ///< as many as asked for, also on a node with fewer cores
  tbb::task_arena arena_;
  std::unique_ptr<tbb::flow::graph> graph_;
  std::vector<LaneNodes> nodes_;
  std::unique_ptr<tbb::flow::function_node<int, Signal>> drain_;
  StepFrame frame_;
  std::mutex comm_mutex_;  ///< one thread at a time in the exchange
  std::array<std::atomic<bool>, 2> arrived_{};
  std::atomic<int> lanes_left_{0};
  std::atomic<bool> left_is_done_{false};
  StepTimes times_;
  Clock::time_point sent_{};
  double poll_seconds_ = 0.0;
  double max_task_delay_;
  std::atomic<std::uint64_t> delay_state_;
};

extern template class StepGraph<2>;
extern template class StepGraph<3>;

}  // namespace barchan
