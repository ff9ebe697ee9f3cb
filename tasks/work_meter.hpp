#pragma once

#include <cstdint>
#include <vector>

namespace barchan {

/// What a particle costs in each lane of a rank, by the clock: cuts follow it. A worker that was
/// interrupted makes its lane look slow for a while, so of the times between rebuilds the shortest
/// counts, window after window, and windows are smoothed. No bit depends on it.
class WorkMeter {
 public:
  explicit WorkMeter(int num_lanes) : lanes_(static_cast<std::size_t>(num_lanes)) {}

  /// At every rebuild, before particles move on.
  /// @param ns  that the lane has worked in all steps so far. @param particles  that it has now
  void note(int lane, std::int64_t ns, std::int64_t particles, std::int64_t step);
  /// Ends a window: cuts are about to move.
  void end_window();
  /// Of a particle, in parts of a nanosecond: whole numbers, so that all ranks find the same sums.
  /// At least 1.
  [[nodiscard]] std::int64_t weight(int lane) const;

 private:
  struct OfLane {
    std::int64_t ns = 0, step = 0;  ///< when last noted
    double shortest = 0.0;          ///< in this window [ns a particle and step]; 0: not known
    double smoothed = 0.0;          ///< over windows; 0: not known
  };
  std::vector<OfLane> lanes_;
};

}  // namespace barchan
