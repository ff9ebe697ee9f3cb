#include <barchan/tasks/strip_seed.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

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

}  // namespace

template <int Dim>
void seed_lanes(Strip<Dim>& strip, const ParticleSet& set, std::span<const CellAt<Dim>> cells,
                std::span<const Placement<Dim>> places) {
  const BondGeometry bonds = bond_geometry<Dim>(strip.world().grid.box(), set);
  for (std::size_t l = 0; l < strip.lanes().size(); ++l) {
    std::vector<ParticleData> mine;
    std::vector<char> is_bonded;
    for (std::size_t p = 0; p < set.particles.size(); ++p) {
      if (!places[l].box.contains(cells[p])) continue;
      mine.push_back(set.particles[p]);
      is_bonded.push_back(bonds.is_bonded[p]);
    }
    strip.lanes()[l].rebuild.seed(places[l], mine, set.bonds, bonds.lengths, is_bonded);
  }
}

template void seed_lanes<2>(Strip<2>&, const ParticleSet&, std::span<const CellAt<2>>,
                            std::span<const Placement<2>>);
template void seed_lanes<3>(Strip<3>&, const ParticleSet&, std::span<const CellAt<3>>,
                            std::span<const Placement<3>>);

}  // namespace barchan
