#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include <barchan/core/base/vec.hpp>
#include <barchan/core/particles/particle_store.hpp>
#include <barchan/core/particles/share.hpp>

// What a particle has, said once. Rows are moved, sent, saved and brought back by these two tables;
// a test holds docs/extending.md against them.

namespace barchan {

/// An array of the store that goes wherever its rows go: to another place, another lane, a ghost.
template <int Dim, class T>
struct RowArray {
  AlignedVector<T> ParticleStore<Dim>::*values;
  int width;  ///< numbers a row
  /// Of owned rows alone, and only while someone uses it: else it is empty, which means zeros.
  bool is_optional = false;
  /// Only where particles have temperatures (ParticleStore::has_heat).
  bool is_of_heat = false;

  [[nodiscard]] bool is_in(const ParticleStore<Dim>& store) const {
    return is_of_heat ? store.has_heat : !is_optional || !(store.*values).empty();
  }
};

/// Wider numbers first, so that records of them need no gaps.
template <int Dim>
inline constexpr std::tuple kRowArrays{
    RowArray<Dim, double>{&ParticleStore<Dim>::motion, Layout<Dim>::kMotion},
    RowArray<Dim, double>{&ParticleStore<Dim>::spin, Layout<Dim>::kSpin},
    RowArray<Dim, double>{&ParticleStore<Dim>::density, 1},
    RowArray<Dim, double>{&ParticleStore<Dim>::external, Layout<Dim>::kForce, true},
    RowArray<Dim, double>{&ParticleStore<Dim>::heat, 2, false, true},
    RowArray<Dim, std::int64_t>{&ParticleStore<Dim>::id, 1},
    RowArray<Dim, std::int64_t>{&ParticleStore<Dim>::key, 1},
    RowArray<Dim, std::uint8_t>{&ParticleStore<Dim>::type, 1},
    RowArray<Dim, std::uint8_t>{&ParticleStore<Dim>::flags, 1},
};

template <int Dim, class Visit>
constexpr void for_each_array(Visit&& visit) {
  std::apply([&](const auto&... array) { (visit(array), ...); }, kRowArrays<Dim>);
}

/// Numbers of a particle: where a row has them, and where else they go.
template <int Dim, class T>
struct Field {
  std::string_view name, unit;
  RowArray<Dim, T> array;
  int at, width;         ///< within a row of the array
  bool is_in_halo;       ///< sent to ghosts in every step
  std::uint32_t column;  ///< number in checkpoints, part of their format
  std::vector<T> CheckpointShare::*saved;
  using Number = T;

  [[nodiscard]] const T* of(const ParticleStore<Dim>& store, std::int32_t row) const {
    return (store.*array.values).data() + place(row);
  }
  [[nodiscard]] T* of(ParticleStore<Dim>& store, std::int32_t row) const {
    return (store.*array.values).data() + place(row);
  }

 private:
  [[nodiscard]] std::size_t place(std::int32_t row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(array.width) +
           static_cast<std::size_t>(at);
  }
};

template <int Dim>
constexpr auto make_fields() {
  using L = Layout<Dim>;
  using Share = CheckpointShare;
  const auto& [motion, spin, density, external, heat, id, key, type, flags] = kRowArrays<Dim>;
  const auto& surface = std::get < Dim == 2 ? 0 : 1 > (kRowArrays<Dim>);
  using Reals = Field<Dim, double>;
  using Bytes = Field<Dim, std::uint8_t>;
  return std::tuple{
      Field<Dim, std::int64_t>{"ids", "", id, 0, 1, false, 16, &Share::ids},
      Reals{"positions", "m", motion, 0, Dim, true, 18, &Share::positions},
      Reals{"velocities", "m/s", motion, L::kVelocity, Dim, true, 19, &Share::velocities},
      Reals{"surface speeds", "m/s", surface, L::kSurface, kSpins<Dim>, true, 20,
            &Share::surface_speeds},
      Reals{"radii", "m", motion, L::kRadius, 1, false, 21, &Share::radii},
      Reals{"inverse masses", "1/kg", motion, L::kInverseMass, 1, false, 22,
            &Share::inverse_masses},
      Reals{"densities", Dim == 2 ? "kg/m²" : "kg/m³", density, 0, 1, false, 26, &Share::densities},
      Bytes{"types", "", type, 0, 1, false, 23, &Share::types},
      Bytes{"flags", "", flags, 0, 1, false, 24, &Share::flags},
      Reals{"external forces", "N", external, 0, L::kForce, false, 25, &Share::externals},
      Reals{"temperatures", "K", heat, 0, 1, true, 27, &Share::temperatures},
      Reals{"temperature remainders", "K", heat, 1, 1, false, 28, &Share::temperature_remainders},
  };
}

/// All that a particle has but its cell, which follows from where it is.
template <int Dim>
inline constexpr auto kFields = make_fields<Dim>();

template <int Dim, class Visit>
constexpr void for_each_field(Visit&& visit) {
  std::apply([&](const auto&... field) { (visit(field), ...); }, kFields<Dim>);
}

/// Bytes a particle in a halo: its fields there, in the order of the table.
template <int Dim>
constexpr std::size_t halo_record_bytes(bool has_heat = false) {
  std::size_t bytes = 0;
  for_each_field<Dim>([&](const auto& field) {
    using Number = typename std::decay_t<decltype(field)>::Number;
    if (field.is_in_halo && (has_heat || !field.array.is_of_heat))
      bytes += static_cast<std::size_t>(field.width) * sizeof(Number);
  });
  return bytes;
}

}  // namespace barchan
