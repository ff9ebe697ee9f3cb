#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <barchan/core/base/vec.hpp>
#include <barchan/core/particles/particle_store.hpp>

// Loads of callers in the rows of a store.

namespace barchan {

/// Where the c-th number of an angular velocity or torque is among three.
template <int Dim>
[[nodiscard]] constexpr int place_of_turn(int c) {
  return Dim == 2 ? 2 : c;
}

/// Loads of all owned rows can be written.
template <int Dim>
void make_room(ParticleStore<Dim>& store) {
  constexpr std::size_t kForce = Layout<Dim>::kForce;
  store.external.resize(static_cast<std::size_t>(store.num_owned) * kForce, 0.0);
}

/// @param force, torque  three numbers each; null: as it was
template <int Dim>
void put_load(ParticleStore<Dim>& store, std::int32_t row, const double* force,
              const double* torque) {
  double* to =
      store.external.data() + std::size_t{Layout<Dim>::kForce} * static_cast<std::size_t>(row);
  if (force != nullptr) std::copy_n(force, Dim, to);
  if (torque == nullptr) return;
  const double r = store.radius(row);
  for (int c = 0; c < kSpins<Dim>; ++c)
    to[Layout<Dim>::kTorque + c] = torque[place_of_turn<Dim>(c)] / r;
}

/// Without a look at the radius, which lies far from the loads.
template <int Dim>
void clear_torque(ParticleStore<Dim>& store, std::int32_t row) {
  std::fill_n(store.external.data() + Layout<Dim>::kTorque +
                  std::size_t{Layout<Dim>::kForce} * static_cast<std::size_t>(row),
              kSpins<Dim>, 0.0);
}

}  // namespace barchan
