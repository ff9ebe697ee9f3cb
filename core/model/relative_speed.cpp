#include <barchan/core/model/relative_speed.hpp>

#include <algorithm>
#include <cmath>

namespace barchan {
namespace {

/// What a particle can fall by along an axis, down to the end of the domain [m²/s²].
double depth_below(const Model& model, const ParticleSet& set, int axis) {
  const double gravity = model.gravity[axis];
  const double lo = model.domain.lo[axis], hi = model.domain.hi[axis];
  if (model.domain.periodic[static_cast<std::size_t>(axis)]) return std::fabs(gravity) * (hi - lo);
  double deepest = 0.0;
  for (const ParticleData& p : set.particles)
    deepest = std::max(deepest, gravity * ((gravity > 0.0 ? hi : lo) - p.position[axis]));
  return deepest;
}

}  // namespace

double relative_speed(const Model& model, const ParticleSet& set) {
  double start = 0.0, depth = 0.0, wall = 0.0;
  for (const ParticleData& p : set.particles) start = std::max(start, p.velocity.norm());
  for (const WallSpec& w : model.walls) wall = std::max(wall, w.velocity.norm());
  for (int c = 0; c < model.dimension; ++c) depth += depth_below(model, set, c);
  return 2.0 * (start + wall) + std::sqrt(2.0 * depth);
}

}  // namespace barchan
