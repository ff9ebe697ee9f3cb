#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/comm/topology/neighbours.hpp>
#include <barchan/core/base/clock.hpp>

namespace barchan {

/// Records what this rank's workers did and when: slices of time by name, messages, counters.
///
/// Each worker writes into a ring of its own, made beforehand: nothing is allocated or locked while
/// a step runs, and the latest events remain when a ring is full. Times are now_ns().
/// Without a trace the code that would record it holds a null pointer: one branch.
class Trace {
 public:
  enum class Slice : std::uint8_t {
    Chunk,
    LeftBand,
    RightBand,
    Send,
    Poll,
    Wait,
    Rebuild,
    Migration,
    Ghosts,
    Reduction,
    Shadows,
    kNum
  };
  enum class Counter : std::uint8_t { ExposedMicroseconds, FlightMicroseconds, kNum };

  /// @param num_workers  threads of the rank; @param num_events  that each of them keeps
  Trace(const Communicator& communicator, const Neighbours& neighbours, int num_workers,
        std::size_t num_events);

  /// From now on only events of these steps are kept.
  void keep(std::int64_t first, std::int64_t last) { first_ = first, last_ = last; }

  // By any worker, in a step.
  /// @param ahead  steps after the one that was begun
  void slice(Slice name, std::int32_t detail, std::int64_t begin, std::int64_t end,
             std::int64_t ahead = 0) {
    put({begin, end, step_ + ahead, detail, Kind::Slice, static_cast<std::uint8_t>(name)});
  }
  /// A halo message that the receiver needs in `step`; at an instant inside a slice of this worker.
  void sent(int link, std::int64_t step, std::int64_t at) {
    put({at, at, step, link, Kind::Sent, 0});
  }
  void noticed(int link, std::int64_t step, std::int64_t at) {
    put({at, at, step, link, Kind::Noticed, 0});
  }
  void count(Counter name, std::int64_t value, std::int64_t at) {
    put({at, value, step_, 0, Kind::Counter, static_cast<std::uint8_t>(name)});
  }
  void begin_step(std::int64_t step) { step_ = step; }
  [[nodiscard]] std::int64_t step() const { return step_; }

  [[nodiscard]] std::size_t num_events() const;  ///< kept now
  [[nodiscard]] std::size_t num_lost() const;    ///< overwritten by later ones

  /// All ranks' events as Chrome's trace events (JSON), on rank 0's clock. Collective; opens in
  /// Perfetto. Errors: RunError when the file cannot be written.
  void write(const std::string& path) const;

 private:
  enum class Kind : std::uint8_t { Slice, Sent, Noticed, Counter };
  struct Event {
    std::int64_t begin, end;  ///< [ns]; Counter: end is the value
    std::int64_t step;
    std::int32_t detail;
    Kind kind;
    std::uint8_t name;
  };
  struct alignas(64) Ring {
    std::vector<Event> events;
    std::size_t num_put = 0;
  };

  void put(const Event& event);
  [[nodiscard]] std::string json_of_rank(double slope, std::int64_t offset) const;
  void append(std::string& text, const Event& event, int worker, double ts, double end) const;
  void append_names(std::string& text) const;

  const Communicator& communicator_;
  Neighbours neighbours_;
  std::vector<Ring> rings_;
  std::int64_t step_ = 0;
  std::int64_t first_ = 0, last_ = std::numeric_limits<std::int64_t>::max();
  std::int64_t begin_ = 0, begin_offset_ = 0;  ///< own clock, and what rank 0's was ahead then
};

}  // namespace barchan
