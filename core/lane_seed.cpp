#include <algorithm>
#include <unordered_map>

#include <barchan/core/lane.hpp>
#include <barchan/core/mass.hpp>

namespace barchan {

template <int Dim>
void Lane<Dim>::seed(int slab_begin, int slab_end, std::span<const ParticleData> particles,
                     std::span<const BondData> bonds, std::span<const double> bond_lengths,
                     std::span<const char> is_bonded) {
  slab_begin_ = slab_begin;
  slab_end_ = slab_end;
  const auto n = static_cast<std::int32_t>(particles.size());
  store_.num_owned = n;
  store_.num_ghosts = {};
  store_.resize_for_ghosts(world_->grain.rounder());
  goes_.assign(particles.size(), 0);
  for (std::int32_t i = 0; i < n; ++i) {
    const ParticleData& p = particles[static_cast<std::size_t>(i)];
    const auto at = static_cast<std::size_t>(i);
    double* x = store_.x(i);
    std::fill_n(x, 8, 0.0);
    for (int c = 0; c < Dim; ++c) {
      x[c] = p.position[c];
      x[L::kVelocity + c] = p.fixed ? 0.0 : p.velocity[c];
    }
    x[L::kRadius] = p.radius;
    x[L::kInverseMass] = p.fixed ? 0.0 : 1.0 / mass_of(p, Dim);
    if constexpr (Dim == 3) std::fill_n(store_.u(i), 4, 0.0);
    for (int c = 0; c < kSpins<Dim>; ++c)
      store_.u(i)[c] = p.fixed ? 0.0 : p.radius * p.omega[Dim == 2 ? 2 : c];
    world_->grid.wrap(x);
    store_.id[at] = p.id;
    store_.key[at] = world_->grid.key(x);
    store_.type[at] = static_cast<std::uint8_t>(p.type);
    store_.flags[at] = static_cast<std::uint8_t>((p.fixed ? Store::kFixed : 0) |
                                                 (is_bonded[at] != 0 ? Store::kBonded : 0));
  }
  for (std::size_t b = 0; b < bonds.size(); ++b)
    bonds_.add(bond_of<Dim>(bonds[b], bond_lengths[b]));
}

template void Lane<2>::seed(int, int, std::span<const ParticleData>, std::span<const BondData>,
                            std::span<const double>, std::span<const char>);
template void Lane<3>::seed(int, int, std::span<const ParticleData>, std::span<const BondData>,
                            std::span<const double>, std::span<const char>);

}  // namespace barchan
