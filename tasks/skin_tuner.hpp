#pragma once

#include <cstdint>

namespace barchan {

/// Looks for the skin with which a run is fastest, by the clock of one rank: a narrow skin lists
/// fewer pairs, a wide one asks for lists less often. No bit depends on it.
///
///   widest · 0.8^k,  k = 0 … 4
///
/// A skin serves for a trial; its neighbour is tried next, and stays if it was faster, as long as
/// that goes on, first narrower, then wider. Then the best one serves for a while.
class SkinTuner {
 public:
  /// @param widest  where it begins [m]
  explicit SkinTuner(double widest) : widest_(widest) {}

  /// The skin that the next lists shall have. @param steps, seconds  of the run so far
  double wish(std::int64_t steps, double seconds);

 private:
  [[nodiscard]] double skin(int k) const;
  void judge(double cost);
  void turn();

  double widest_;
  int best_ = 0, trial_ = 0, direction_ = 1;
  int turns_ = 0;           ///< without anything better
  double best_cost_ = 0.0;  ///< seconds a step; 0: not measured
  int rests_ = 0;           ///< trials that the best one still serves
  std::int64_t begin_step_ = -1;
  double begin_seconds_ = 0.0;
};

}  // namespace barchan
