#pragma once

#include <numbers>

#include <barchan/core/model/model.hpp>

namespace barchan {

/// Of a disk of unit thickness or a sphere, fixed or not [kg].
[[nodiscard]] inline double mass_of(const ParticleData& p, int dimension) {
  const double r = p.radius;
  if (dimension == 2) return p.density * std::numbers::pi * r * r;
  return p.density * (4.0 / 3.0) * std::numbers::pi * r * r * r;
}

}  // namespace barchan
