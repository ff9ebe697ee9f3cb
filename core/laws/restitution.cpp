#include <barchan/core/laws/restitution.hpp>

#include <cmath>
#include <numbers>

namespace barchan {
namespace {

/// arccos(z)/sqrt(1 − z²) and, beyond 1, arcosh(z)/sqrt(z² − 1): one smooth function, 1 at z = 1.
double angle_over_sine(double z) {
  const double s = std::sqrt(std::fabs((1.0 - z) * (1.0 + z)));
  if (s == 0.0) return 1.0;
  return (z < 1.0 ? std::atan2(s, z) : std::asinh(s)) / s;
}

}  // namespace

double restitution_at(double damping_ratio, bool no_tension) {
  const double z = damping_ratio;
  if (no_tension) return std::exp(-2.0 * z * angle_over_sine(z));
  return z < 1.0 ? std::exp(-std::numbers::pi * z / std::sqrt((1.0 - z) * (1.0 + z))) : 0.0;
}

double damping_ratio_for(double restitution, bool no_tension) {
  const double decay = -std::log(restitution);
  if (!no_tension) return decay / std::hypot(decay, std::numbers::pi);
  // e falls with zeta, and e < 1/(4·zeta²). Halving ends where no double lies between.
  double low = 0.0, high = 0.5 / std::sqrt(restitution);
  if (decay <= 0.0) return 0.0;
  while (true) {
    const double middle = low + 0.5 * (high - low);
    if (!(low < middle && middle < high)) return low;
    (2.0 * middle * angle_over_sine(middle) < decay ? low : high) = middle;
  }
}

}  // namespace barchan
