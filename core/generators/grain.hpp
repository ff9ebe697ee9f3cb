#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include <barchan/core/base/vec.hpp>

namespace barchan {

/// A particle of which only place and size are known yet.
struct Grain {
  Vec3 position = Vec3::Zero();  ///< [m]
  double radius = 0.0;           ///< [m]
};

/// Area of a disk [m²] or volume of a sphere [m³].
[[nodiscard]] inline double solid_volume(double radius, int dimension) {
  const double disk = std::numbers::pi * radius * radius;
  return dimension == 2 ? disk : 4.0 / 3.0 * disk * radius;
}

}  // namespace barchan
