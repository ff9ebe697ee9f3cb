#include <barchan/tasks/results/rings.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace barchan {
namespace {

double nearest_image(const Domain& domain, int axis, double distance) {
  if (!domain.periodic[static_cast<std::size_t>(axis)]) return distance;
  const double length = domain.hi[axis] - domain.lo[axis];
  return distance - length * std::rint(distance / length);
}

}  // namespace

std::vector<Ring> find_rings(std::span<const ParticleSource> sources,
                             std::span<const std::size_t> begins, const ParticleSet& particles) {
  std::vector<Ring> rings;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const auto* source = std::get_if<RingSource>(&sources[s].kind);
    if (source == nullptr || begins[s] == begins[s + 1]) continue;
    rings.push_back({"ring" + std::to_string(rings.size() + 1), particles.particles[begins[s]].id,
                     particles.particles[begins[s + 1] - 1].id, source->center});
  }
  return rings;
}

std::vector<double> ring_diameters(const Simulation& simulation, std::span<const Ring> rings) {
  if (rings.empty()) return {};
  // Largest x, largest -x, largest y, largest -y of each ring, from its first centre.
  std::vector<double> reach(4 * rings.size(), -std::numeric_limits<double>::infinity());
  const Domain& domain = simulation.model().domain;
  simulation.for_each_owned([&](const OwnedParticle& p) {
    for (std::size_t k = 0; k < rings.size(); ++k) {
      if (p.id < rings[k].first_id || p.id > rings[k].last_id) continue;
      for (int axis = 0; axis < 2; ++axis) {
        const double d = nearest_image(domain, axis, p.position[axis] - rings[k].center[axis]);
        double* sides = &reach[4 * k + 2 * static_cast<std::size_t>(axis)];
        sides[0] = std::max(sides[0], d);
        sides[1] = std::max(sides[1], -d);
      }
    }
  });
  simulation.communicator().allreduce_max(std::span<double>(reach));
  std::vector<double> diameters;
  for (std::size_t i = 0; i < reach.size(); i += 2) diameters.push_back(reach[i] + reach[i + 1]);
  return diameters;
}

}  // namespace barchan
