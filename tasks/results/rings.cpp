#include <barchan/tasks/results/rings.hpp>

#include <algorithm>
#include <limits>

namespace barchan {
namespace {

constexpr double kAbsent = -std::numeric_limits<double>::infinity();

/// Coordinates of a ring's disks along an axis, the same on every rank, in ascending order; within
/// one period.
std::vector<double> coordinates_of(const Simulation& simulation, const Ring& ring, int axis) {
  const Domain& domain = simulation.model().domain;
  const double lo = domain.lo[axis], hi = domain.hi[axis];
  std::vector<double> x(static_cast<std::size_t>(ring.last_id - ring.first_id + 1), kAbsent);
  simulation.for_each_owned([&](const OwnedParticle& p) {
    if (p.id < ring.first_id || p.id > ring.last_id) return;
    double& at = x[static_cast<std::size_t>(p.id - ring.first_id)] = p.position[axis];
    if (!domain.periodic[static_cast<std::size_t>(axis)]) return;
    if (at < lo) at += hi - lo;
    if (at >= hi) at -= hi - lo;
  });
  simulation.communicator().allreduce_max(std::span<double>(x));
  std::erase(x, kAbsent);
  std::sort(x.begin(), x.end());
  return x;
}

/// Of coordinates in ascending order; around a period, all of it but the widest gap.
double extent(const std::vector<double>& x, bool is_periodic, double period) {
  const double across = x.back() - x.front();
  if (!is_periodic) return across;
  double widest = period - across;
  for (std::size_t i = 1; i < x.size(); ++i) widest = std::max(widest, x[i] - x[i - 1]);
  return widest == period - across ? across : period - widest;
}

}  // namespace

std::vector<Ring> find_rings(std::span<const ParticleSource> sources,
                             std::span<const std::size_t> begins, const ParticleSet& particles) {
  std::vector<Ring> rings;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const auto* source = std::get_if<RingSource>(&sources[s].kind);
    if (source == nullptr || begins[s] == begins[s + 1]) continue;
    rings.push_back({"ring" + std::to_string(rings.size() + 1), particles.particles[begins[s]].id,
                     particles.particles[begins[s + 1] - 1].id});
  }
  return rings;
}

std::vector<std::optional<double>> ring_diameters(const Simulation& simulation,
                                                  std::span<const Ring> rings) {
  const Domain& domain = simulation.model().domain;
  std::vector<std::optional<double>> diameters;
  for (const Ring& ring : rings) {
    for (int axis = 0; axis < 2; ++axis) {
      const std::vector<double> x = coordinates_of(simulation, ring, axis);
      diameters.emplace_back();
      if (x.empty()) continue;
      diameters.back() = extent(x, domain.periodic[static_cast<std::size_t>(axis)],
                                domain.hi[axis] - domain.lo[axis]);
    }
  }
  return diameters;
}

}  // namespace barchan
