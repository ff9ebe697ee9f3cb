#pragma once

#include <utility>
#include <vector>

// How sure a difference between few, noisy times is. No distribution is assumed.

namespace barchan::app {

[[nodiscard]] double median(std::vector<double> values);  ///< 0 for none
/// Largest less smallest over the median; 0 for fewer than two.
[[nodiscard]] double spread(const std::vector<double>& values);

/// An estimate, and the bounds that hold it with this confidence.
struct Interval {
  double value = 0.0, low = 0.0, high = 0.0;
  double confidence = 0.0;  ///< 0: too few values to have bounds

  [[nodiscard]] bool holds(double number) const { return low <= number && number <= high; }
};

/// The factor between pairs of positive values, second over first: the median of the ratios with
/// the bounds of the sign test, exact for any noise. A run that something held up spoils its own
/// pair only. Where so few pairs cannot give the confidence asked for, the bounds are the widest.
[[nodiscard]] Interval paired_ratio(const std::vector<std::pair<double, double>>& pairs,
                                    double confidence);

/// The same for values that are not in pairs, b over a: Hodges and Lehmann's estimate with the
/// bounds of Mann and Whitney.
[[nodiscard]] Interval unpaired_ratio(const std::vector<double>& a, const std::vector<double>& b,
                                      double confidence);

}  // namespace barchan::app
