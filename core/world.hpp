#pragma once

#include <cstdint>
#include <vector>

#include <barchan/core/bonds.hpp>
#include <barchan/core/grid.hpp>
#include <barchan/core/kernels/kernel_set.hpp>
#include <barchan/core/law_table.hpp>
#include <barchan/core/model.hpp>
#include <barchan/core/walls.hpp>

namespace barchan {

/// What all lanes of a run share.
template <int Dim>
struct World {
  Grid<Dim> grid;
  LawTable laws;
  KernelSet kernels;
  std::vector<BondLaw> bond_laws;
  std::vector<WallSpec> wall_specs;
  std::vector<WallState> walls;
  ContactSearchKind search = ContactSearchKind::Cells;
  double skin = 0.0;  ///< [m]
  double dt = 0.0;    ///< [s]
  std::int64_t num_particles = 0;
};

/// What changes from step to step.
struct StepFrame {
  double kick = 0.0;           ///< dt, or dt/2 in the first step [s]
  double gravity[3] = {};      ///< [m/s²]
  double local_damping = 0.0;  ///< of the stage (Stage)
};

}  // namespace barchan
