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
  ForceGrain grain;
};

/// Fills an empty world from a model. Pure but for the machine's vector widths.
template <int Dim>
void set_up(World<Dim>& world, const Model& model, const WorldScale& scale, VectorWidth width);

extern template void set_up(World<2>&, const Model&, const WorldScale&, VectorWidth);
extern template void set_up(World<3>&, const Model&, const WorldScale&, VectorWidth);

}  // namespace barchan
