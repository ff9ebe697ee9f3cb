#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <barchan/core/base/vec.hpp>
#include <barchan/core/particles/particle_store.hpp>

// Loads of callers in the rows of a store.

namespace barchan {

template <int Dim>
inline constexpr int kTurns = Dim == 2 ? 1 : 3;
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

}  // namespace barchan
