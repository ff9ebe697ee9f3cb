#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <barchan/core/base/rows.hpp>
#include <barchan/core/base/side.hpp>
#include <barchan/core/particles/layout.hpp>

namespace barchan {

/// Particles of one lane (fields.hpp says what they have), by cells, then two rows that belong to
/// nobody, then ghosts:
///
///   | owned 0 … n−1 | waste n, n+1 | left ghosts | right ghosts |
///
/// The waste rows pad batches of pairs: they never touch, for their radius is 0 (and their 1/r 1).
template <int Dim>
struct ParticleStore {
  using L = Layout<Dim>;

  AlignedVector<double> motion, spin, force;
  AlignedVector<double> density;    ///< [kg/m³], 2D [kg/m²]
  AlignedVector<double> reference;  ///< owned: positions at the last rebuild, Dim each
  AlignedVector<std::int64_t> id;
  AlignedVector<std::int64_t> key;   ///< cell at the last rebuild
  AlignedVector<std::uint8_t> type;  ///< material
  AlignedVector<std::uint8_t> flags;
  AlignedVector<double> external;  ///< owned: force records added each step; empty unless asked for
  AlignedVector<double> heat;      ///< temperature and its remainder [K]; empty without has_heat
  AlignedVector<double> heat_flow;  ///< into each row and the sum of sizes [W]; see heat.hpp
  AlignedVector<double> extra;      ///< force records beside contacts, of rows from extra_begin on
  std::int32_t extra_begin = 0;
  AlignedVector<double> carried;  ///< fields of the caller's own, num_carried a row
  std::int32_t num_carried = 0;   ///< see caller_fields.hpp
  bool has_heat = false;          ///< particles have temperatures
  std::int32_t num_owned = 0;
  std::array<std::int32_t, 2> num_ghosts{};

  enum Flag : std::uint8_t { kFixed = 1, kBonded = 2 };

  [[nodiscard]] std::int32_t waste() const { return num_owned; }
  [[nodiscard]] std::int32_t ghost_begin(Side side) const {
    return num_owned + 2 + (side == Side::Right ? num_ghosts[0] : 0);
  }
  [[nodiscard]] Rows ghosts(Side side) const {
    const std::int32_t begin = ghost_begin(side);
    return {begin, begin + num_ghosts[index_of(side)]};
  }
  [[nodiscard]] std::int32_t size() const { return num_owned + 2 + num_ghosts[0] + num_ghosts[1]; }
  [[nodiscard]] bool is_owned(std::int32_t i) const { return i < num_owned; }

  [[nodiscard]] double* x(std::int32_t i) {
    return motion.data() + std::size_t{L::kMotion} * static_cast<std::size_t>(i);
  }
  [[nodiscard]] const double* x(std::int32_t i) const {
    return motion.data() + std::size_t{L::kMotion} * static_cast<std::size_t>(i);
  }
  [[nodiscard]] double* v(std::int32_t i) { return x(i) + L::kVelocity; }
  [[nodiscard]] const double* v(std::int32_t i) const { return x(i) + L::kVelocity; }
  /// Surface velocity u = r·omega.
  [[nodiscard]] double* u(std::int32_t i) {
    if constexpr (Dim == 2) return x(i) + L::kSurface;
    return spin.data() + std::size_t{4} * static_cast<std::size_t>(i);
  }
  [[nodiscard]] const double* u(std::int32_t i) const {
    return const_cast<ParticleStore*>(this)->u(i);
  }
  [[nodiscard]] double* f(std::int32_t i) {
    return force.data() + std::size_t{L::kForce} * static_cast<std::size_t>(i);
  }
  /// Temperature and its remainder [K]. @pre has_heat
  [[nodiscard]] double* t(std::int32_t i) { return heat.data() + 2 * static_cast<std::size_t>(i); }
  [[nodiscard]] const double* t(std::int32_t i) const {
    return heat.data() + 2 * static_cast<std::size_t>(i);
  }
  /// Heat flow and sum of sizes [W]. @pre has_heat
  [[nodiscard]] double* q(std::int32_t i) {
    return heat_flow.data() + 2 * static_cast<std::size_t>(i);
  }
  [[nodiscard]] std::span<double> carried_by(std::int32_t i) {
    const auto n = static_cast<std::size_t>(num_carried);
    return {carried.data() + n * static_cast<std::size_t>(i), n};
  }
  [[nodiscard]] std::span<const double> carried_by(std::int32_t i) const {
    return const_cast<ParticleStore*>(this)->carried_by(i);
  }
  /// Of walls, bonds and callers. @pre start_extra() with this row
  [[nodiscard]] double* e(std::int32_t i) {
    return extra.data() + std::size_t{L::kForce} * static_cast<std::size_t>(i - extra_begin);
  }
  [[nodiscard]] double radius(std::int32_t i) const { return x(i)[L::kRadius]; }
  [[nodiscard]] double inverse_mass(std::int32_t i) const { return x(i)[L::kInverseMass]; }
  [[nodiscard]] double inverse_radius(std::int32_t i) const {
    return (Dim == 2 ? x(i) : u(i))[L::kInverseRadius];
  }
  void set_radius(std::int32_t i, double radius) {
    x(i)[L::kRadius] = radius;
    (Dim == 2 ? x(i) : u(i))[L::kInverseRadius] = 1.0 / radius;
  }

  /// Every row carries so many numbers, the new ones zeros. @pre not fewer than before
  void set_num_carried(std::int32_t n);
  /// Makes room for so many rows of all that moves with a row, but for optional arrays.
  void resize_rows(std::size_t n);
  /// Makes room for all rows, waste rows set. @param rounder  what sums of forces start from
  /// @param heat_rounder  what sums of heat flows start from
  void resize_for_ghosts(double rounder = 0.0, double heat_rounder = 0.0);
  /// Forces of rows [begin, end) start from the rounder.
  void start_forces(double rounder, std::int32_t begin, std::int32_t end);
  /// Heat flows of rows [begin, end) start from the rounder. @pre has_heat
  void start_flows(double rounder, std::int32_t begin, std::int32_t end);
  /// Extra forces of rows [begin, end) are zero; those of other rows are gone.
  void start_extra(std::int32_t begin, std::int32_t end);
  /// Takes the rounder out of the forces of rows [begin, end).
  void take_out(double rounder, std::int32_t begin, std::int32_t end);
  [[nodiscard]] std::size_t bytes() const;
};

extern template struct ParticleStore<2>;
extern template struct ParticleStore<3>;

}  // namespace barchan
