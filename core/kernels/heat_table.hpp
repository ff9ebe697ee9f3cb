#pragma once

#include <cstddef>
#include <vector>

#include <barchan/core/kernels/force_grain.hpp>
#include <barchan/core/model/model.hpp>

namespace barchan {

/// How heat flows in a run, and how much warms a particle.
///
///   Q = h·(T_j − T_i)       h = 2·k·a                    spheres: a the radius of the contact
///                           h = k·2a / (r_i + r_j)       disks of unit thickness: 2a its width
///   k = 2·k_i·k_j / (k_i + k_j)
///
/// Source: Batchelor & O'Brien 1977, doi:10.1098/rspa.1977.0100, of spheres in a vacuum; that
/// of disks is ours: a bar as wide as the contact and as long as the two radii.
struct HeatTable {
  bool is_on = false;
  bool dissipates = false;  ///< what contacts lose warms their particles
  double start = 0.0;       ///< of particles that do not say [K]
  ForceGrain grain;         ///< of flows, in W instead of N
  std::size_t num_materials = 0;
  std::vector<double> conductivity;   ///< k of pairs of materials [W/(m·K)]
  std::vector<double> heat_capacity;  ///< of materials [J/(kg·K)]

  HeatTable() = default;
  HeatTable(const Model& model, const ForceGrain& grain);

  [[nodiscard]] double between(int a, int b) const {
    return conductivity[static_cast<std::size_t>(a) * num_materials + static_cast<std::size_t>(b)];
  }
};

/// h of a contact [W/K]. @param radius  of the contact [m]. @param reach  r_i + r_j, at a wall r_i
template <int Dim>
[[nodiscard]] inline double conductance(double conductivity, double radius, double reach) {
  const double twice = conductivity * (radius + radius);
  return Dim == 2 ? twice / reach : twice;
}

/// The largest step of conduction, of the particles of a material [s]: heat capacity over the
/// conductance of 12 of the widest contacts (disks: 6) of the smallest of them. Widest: with
/// the overlap of limits.overlap_error. Within it no temperature leaves the range of those around.
struct HeatLimit {
  int material = 0;
  double step = 0.0;
};
/// Of materials that particles are made of. Pure; the same on every rank.
[[nodiscard]] std::vector<HeatLimit> heat_limits(const Model& model, const ParticleSet& particles);

/// The grain of heat flows: the finest one for a particle with the widest contacts all around, and
/// of each the largest difference of temperature, beside what the strongest contacts may lose.
/// Pure; the same on every rank. @param particles  of the start
[[nodiscard]] ForceGrain heat_grain(const Model& model, const ParticleSet& particles);

}  // namespace barchan
