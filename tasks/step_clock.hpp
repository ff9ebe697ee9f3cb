#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <span>

#include <barchan/core/base/side.hpp>
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

/// The times of the step graph's tasks and messages, summed up and, with a trace, recorded.
/// Times of the clock are now_ns().
class StepClock {
 public:
  /// @param has_shadows  what is noticed is theirs, not a message
  explicit StepClock(int num_lanes, bool has_shadows = false)
      : lanes_(static_cast<std::size_t>(num_lanes)), has_shadows_(has_shadows) {}

  /// @param trace  lives longer; null: stop recording
  void set_trace(Trace* trace) { trace_ = trace; }

  // ---- by the task that works on the lane. step: of the run
  void chunk(int lane, int step, std::int64_t begin, std::int64_t end);
  /// The lane has no chunk left, and is idle until a band of it begins.
  void chunks_end(int lane);
  void band(int lane, Side side, int step, std::int64_t begin, std::int64_t end);

  // ---- by who holds the exchange
  struct Sending {
    std::int64_t begin, handed_over, end;  ///< handed over: to the exchange, packed
  };
  /// @param in_exchange  of the time from begin to end [ns]; the rest is packing
  void sent(int link, const Sending& times, std::int64_t in_exchange);
  /// @param found  the links whose halo it found
  /// @param worked  of the time since, in steps of shadows [ns]
  void polled(std::int64_t begin, std::span<const int> found, std::int64_t worked);
  /// @param posted  when the neighbour sent it; 0: not known. @param is_last  all halos are in now
  /// @param lane  that the link belongs to
  void noticed(int link, int lane, std::int64_t posted, bool is_last);
  struct Instant {
    std::int64_t at, busy;  ///< busy: in bands so far
  };
  /// Idle workers wait for halos: all, but for the time that some spend in bands meanwhile.
  void begin_wait(const Instant& begin);
  /// @param worked  by who waited, in steps of shadows [ns]
  void end_wait(const Instant& begin, const Instant& end, std::int64_t worked);

  // ---- by anyone
  [[nodiscard]] Instant instant() const;

  // ---- between steps
  void begin_run();
  void end_run(std::int64_t begin);
  [[nodiscard]] StepTimes times() const;
  /// That a lane has worked in chunks and bands [ns].
  [[nodiscard]] std::int64_t worked(int lane) const {
    const OfLane& of = lanes_[static_cast<std::size_t>(lane)];
    return of.chunks + of.bands;
  }

 private:
  struct alignas(64) OfLane {
    std::int64_t chunks = 0, bands = 0;
    std::atomic<std::int64_t> idle_since{0};  ///< chunks done, a message missing; 0: not so
  };
  void count_exposed();
  [[nodiscard]] OfLane& of(int lane) { return lanes_[static_cast<std::size_t>(lane)]; }
  [[nodiscard]] int num_lanes() const { return static_cast<int>(lanes_.size()); }

  std::deque<OfLane> lanes_;
  bool has_shadows_;
  Trace* trace_ = nullptr;
  // All in nanoseconds.
  std::int64_t send_ = 0, poll_ = 0, wait_ = 0, late_ = 0, flight_ = 0, run_ = 0;
  std::atomic<std::int64_t> busy_{0};            ///< in bands, and shadows between chunks
  std::int64_t waits_since_ = 0;                 ///< 0: nobody does
  std::int64_t posted_ = 0;                      ///< the last that came in a wait, by its sender
  std::int64_t sent_at_ = 0, next_sent_at_ = 0;  ///< first send of this step's halo, of the next's
  std::int64_t exposed_before_ = 0, flight_before_ = 0;
};

}  // namespace barchan
