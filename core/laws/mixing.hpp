#pragma once

#include <cmath>

// What two materials have together, from what each has with its like.

namespace barchan {

/// Of two springs, or dashpots, in series, each half of a contact; 0 where one of them is.
[[nodiscard]] inline double in_series(double a, double b) {
  return a > 0.0 && b > 0.0 ? 2.0 / (1.0 / a + 1.0 / b) : 0.0;
}

[[nodiscard]] inline double geometric_mean(double a, double b) {
  return a == b ? a : std::sqrt(a) * std::sqrt(b);
}

}  // namespace barchan
