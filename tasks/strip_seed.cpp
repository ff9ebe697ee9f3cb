#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <barchan/comm/topology/strips.hpp>
#include <barchan/tasks/strip.hpp>

// The strip of one rank at the start of a run. Every rank has all particles at hand and keeps its
// own.

namespace barchan {
namespace {

/// What the particles' set does not hold of its bonds.
struct BondGeometry {
  std::vector<double> lengths;  ///< at the start, across periodic ends [m]; by bond
  std::vector<char> is_bonded;  ///< by particle
};

template <int Dim>
BondGeometry bond_geometry(const PeriodicBox& box, const ParticleSet& set) {
  BondGeometry geometry;
  geometry.is_bonded.assign(set.particles.size(), 0);
  if (set.bonds.empty()) return geometry;
  std::vector<std::pair<std::int64_t, std::size_t>> by_id;
  for (std::size_t p = 0; p < set.particles.size(); ++p) by_id.emplace_back(set.particles[p].id, p);
  std::sort(by_id.begin(), by_id.end());
  const auto find = [&](std::int64_t id) {
    return std::lower_bound(by_id.begin(), by_id.end(), std::pair(id, std::size_t{0}))->second;
  };
  for (const BondData& bond : set.bonds) {
    const std::size_t a = find(bond.id_a), b = find(bond.id_b);
    geometry.is_bonded[a] = geometry.is_bonded[b] = 1;
    geometry.lengths.push_back(std::sqrt(
        distance2<Dim>(box, set.particles[a].position.data(), set.particles[b].position.data())));
  }
  return geometry;
}

template <int Dim>
std::vector<int> slabs_of(const Grid<Dim>& grid, const ParticleSet& set) {
  std::vector<int> slabs;
  slabs.reserve(set.particles.size());
  for (const ParticleData& particle : set.particles) {
    double x[3] = {particle.position[0], particle.position[1], particle.position[2]};
    grid.wrap(x);
    slabs.push_back(grid.coordinate(x, 0));
  }
  return slabs;
}

}  // namespace

template <int Dim>
void Strip<Dim>::seed(const ParticleSet& set) {
  const std::vector<int> slabs = slabs_of(world_.grid, set);
  std::vector<std::int64_t> counts(static_cast<std::size_t>(world_.grid.num_slabs()), 0);
  for (const int slab : slabs) ++counts[static_cast<std::size_t>(slab)];
  cuts_ = cut_equal(counts, total_lanes(), kMinSlabs);

  const BondGeometry bonds = bond_geometry<Dim>(world_.grid.box(), set);
  for (int l = 0; l < num_lanes(); ++l) {
    const int begin = cuts_[static_cast<std::size_t>(first_lane() + l)],
              end = cuts_[static_cast<std::size_t>(first_lane() + l + 1)];
    std::vector<ParticleData> mine;
    std::vector<char> is_bonded;
    for (std::size_t p = 0; p < set.particles.size(); ++p) {
      if (slabs[p] < begin || slabs[p] >= end) continue;
      mine.push_back(set.particles[p]);
      is_bonded.push_back(bonds.is_bonded[p]);
    }
    lane(l).seed(begin, end, mine, set.bonds, bonds.lengths, is_bonded);
    lane(l).order();
  }
  exchange_ghosts(one_by_one());
  for (const auto& lane : lanes_) {
    lane->restart_search_seconds();  // setting up is not part of the loop
    lane->forget_imbalance();
  }
}

template void Strip<2>::seed(const ParticleSet&);
template void Strip<3>::seed(const ParticleSet&);

}  // namespace barchan
