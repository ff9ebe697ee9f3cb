#pragma once

#include <numbers>

#include <barchan/core/model/model.hpp>

namespace barchan {

/// Of a disk of unit thickness or a sphere, fixed or not [kg].
[[nodiscard]] inline double mass_of(double density, double r, int dimension) {
  if (dimension == 2) return density * std::numbers::pi * r * r;
  return density * (4.0 / 3.0) * std::numbers::pi * r * r * r;
}
[[nodiscard]] inline double mass_of(const ParticleData& p, int dimension) {
  return mass_of(p.density, p.radius, dimension);
}

}  // namespace barchan
