#pragma once

#include <cstdint>

#include <barchan/core/brick/world.hpp>
#include <barchan/core/kernels/kernel_set.hpp>
#include <barchan/core/model/model.hpp>

namespace barchan {

/// What the particles of the start determine, and all lists with it.
struct WorldScale {
  double skin = 0.0, reach = 0.0;  ///< [m]
  std::int64_t num_particles = 0;
  bool has_bonds = false;
  ForceGrain grain, heat_grain;
  int num_carried = 0;  ///< by a particle, in fields of the caller's own
};

/// Of the start of a run. Pure.
[[nodiscard]] WorldScale scale_of(const Model& model, const ParticleSet& particles);

/// Without particles. Pure but for the machine's vector widths.
template <int Dim>
[[nodiscard]] World<Dim> make_world(const Model& model, const WorldScale& scale, VectorWidth width);

}  // namespace barchan
