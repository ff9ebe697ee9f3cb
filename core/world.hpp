#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
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
  /// Half of the smallest radius: where nothing moves farther in a step, no contact is skipped [m].
  double quick_travel = std::numeric_limits<double>::infinity();
  /// Beyond this travel in a step nobody looks whether a contact was skipped [m].
  double most_travel = std::numeric_limits<double>::infinity();
  double dt = 0.0;  ///< [s]
  std::int64_t num_particles = 0;

  /// Where two move by most_travel each, either no contact is skipped, or lists have all those that
  /// might be.
  void set_guards(double smallest_radius) {
    quick_travel = 0.5 * smallest_radius;
    most_travel = 0.5 * std::max(skin, smallest_radius);
  }
};

/// What changes from step to step.
struct StepFrame {
  double kick = 0.0;           ///< dt, or dt/2 in the first step [s]
  double gravity[3] = {};      ///< [m/s²]
  double local_damping = 0.0;  ///< of the stage (Stage)
};

}  // namespace barchan
