#include <barchan/core/brick/lane.hpp>
#include <barchan/core/particles/row_particle.hpp>

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
    const auto at = static_cast<std::size_t>(i);
    set_particle(store_, i, particles[at], is_bonded[at] != 0);
    world_->grid.wrap(store_.x(i));
    store_.key[at] = world_->grid.key(store_.x(i));
  }
  for (std::size_t b = 0; b < bonds.size(); ++b)
    bonds_.add(bond_of<Dim>(bonds[b], bond_lengths[b]));
}

template void Lane<2>::seed(int, int, std::span<const ParticleData>, std::span<const BondData>,
                            std::span<const double>, std::span<const char>);
template void Lane<3>::seed(int, int, std::span<const ParticleData>, std::span<const BondData>,
                            std::span<const double>, std::span<const char>);

}  // namespace barchan
