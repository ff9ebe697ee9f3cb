#include <barchan/core/particles/row_particle.hpp>

#include <algorithm>

#include <barchan/core/model/mass.hpp>
#include <barchan/core/particles/row_record.hpp>

namespace barchan {
namespace {

/// Of the three components that files give an angular velocity.
template <int Dim>
constexpr int spin_component(int c) {
  return Dim == 2 ? 2 : c;
}

}  // namespace

template <int Dim>
void set_particle(ParticleStore<Dim>& store, std::int32_t row, const ParticleData& p,
                  bool is_bonded) {
  using L = Layout<Dim>;
  using Store = ParticleStore<Dim>;
  const auto at = static_cast<std::size_t>(row);
  RowRecord<Dim>().put(store, row);
  std::ranges::fill(store.carried_by(row), 0.0);
  double *x = store.x(row), *v = store.v(row), *u = store.u(row);
  for (int c = 0; c < Dim; ++c) {
    x[c] = p.position[c];
    v[c] = p.fixed ? 0.0 : p.velocity[c];
  }
  for (int c = 0; c < kSpins<Dim>; ++c)
    u[c] = p.fixed ? 0.0 : p.radius * p.omega[spin_component<Dim>(c)];
  store.set_radius(row, p.radius);
  x[L::kInverseMass] = p.fixed ? 0.0 : 1.0 / mass_of(p, Dim);
  store.density[at] = p.density;
  if (store.has_heat) *store.t(row) = p.temperature;
  store.id[at] = p.id;
  store.type[at] = static_cast<std::uint8_t>(p.type);
  store.flags[at] =
      static_cast<std::uint8_t>((p.fixed ? Store::kFixed : 0) | (is_bonded ? Store::kBonded : 0));
}

template <int Dim>
ParticleData particle_at(const ParticleStore<Dim>& store, std::int32_t row) {
  const auto at = static_cast<std::size_t>(row);
  ParticleData p;
  p.id = store.id[at];
  p.type = store.type[at];
  p.radius = store.radius(row);
  p.density = store.density[at];
  if (store.has_heat) p.temperature = *store.t(row);
  p.fixed = (store.flags[at] & ParticleStore<Dim>::kFixed) != 0;
  for (int c = 0; c < Dim; ++c) {
    p.position[c] = store.x(row)[c];
    p.velocity[c] = store.v(row)[c];
  }
  for (int c = 0; c < kSpins<Dim>; ++c)
    p.omega[spin_component<Dim>(c)] = store.u(row)[c] / p.radius;
  return p;
}

template void set_particle(ParticleStore<2>&, std::int32_t, const ParticleData&, bool);
template void set_particle(ParticleStore<3>&, std::int32_t, const ParticleData&, bool);
template ParticleData particle_at(const ParticleStore<2>&, std::int32_t);
template ParticleData particle_at(const ParticleStore<3>&, std::int32_t);

}  // namespace barchan
