#pragma once

#include <cmath>
#include <limits>

namespace barchan {

/// The largest step that is stable for a mass on a spring and a dashpot (tasks/stability.hpp says
/// how); infinite where there is neither. [kg, N/m, N·s/m, s]
[[nodiscard]] inline double stable_step(double m, double k, double c) {
  if (k > 0.0) return (std::sqrt(c * c + 4.0 * m * k) - c) / k;
  return c > 0.0 ? 2.0 * m / c : std::numeric_limits<double>::infinity();
}

}  // namespace barchan
