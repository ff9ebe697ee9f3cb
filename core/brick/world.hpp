#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <barchan/core/kernels/force_grain.hpp>
#include <barchan/core/kernels/heat_table.hpp>
#include <barchan/core/kernels/kernel_set.hpp>
#include <barchan/core/kernels/law_table.hpp>
#include <barchan/core/links/bonds.hpp>
#include <barchan/core/links/walls.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/core/search/grid.hpp>

namespace barchan {

/// Travel with lists of a skin, squared, over that up to which they have all contacts.
[[nodiscard]] inline double outrun_share(double distance2, double skin) {
  if (distance2 == 0.0) return 0.0;
  return distance2 / (0.25 * skin * skin);
}

/// What all bricks of a run share.
template <int Dim>
struct World {
  Grid<Dim> grid;
  LawTable laws;
  ForceGrain grain;
  HeatTable heat;
  KernelSet kernels;
  std::vector<BondLaw> bond_laws;
  std::vector<WallSpec> wall_specs;
  std::vector<WallShape<Dim>> wall_shapes;
  std::vector<WallState> walls;
  ContactSearchKind search = ContactSearchKind::Cells;
  double skin = 0.0;   ///< that the next lists get [m]
  double range = 0.0;  ///< beyond touch, up to which the law's contacts may hold [m]
  /// Half of the smallest radius: where nothing moves farther in a step, no contact is skipped [m].
  double quick_travel = std::numeric_limits<double>::infinity();
  double dt = 0.0;        ///< of the coming step, or of the one under way [s]
  double last_dt = 0.0;   ///< of the step before; before the first one dt [s]
  bool accounts = false;  ///< for where energy goes (energy_works.hpp)
  std::int64_t num_particles = 0;
  std::int32_t num_carried = 0;  ///< numbers of a particle in fields of the caller's own

  /// In a step, with lists of a skin. Of two that move by more each, lists may lack one that was
  /// passed (passage.hpp) [m].
  [[nodiscard]] double most_travel(double lists_skin) const {
    return std::max(0.5 * lists_skin, quick_travel);
  }

  /// Of candidates that do not touch most are left out of the step (packing.hpp).
  [[nodiscard]] bool packs() const {
    return kernels.narrow != nullptr && search == ContactSearchKind::Cells;
  }
  [[nodiscard]] const History& history_form() const {
    return laws.law().template in<Dim>().history;
  }

  /// Walls where the run begins. @pre the grid is made
  void set_walls(std::span<const WallSpec> specs) {
    wall_specs.assign(specs.begin(), specs.end());
    wall_shapes.clear();
    walls.clear();
    for (const WallSpec& spec : specs) {
      wall_shapes.emplace_back(spec, grid.box());
      WallState& state = walls.emplace_back();
      state.point = spec.point;
      state.velocity = spec.velocity;
      state.is_active = spec.from_stage <= 0;
    }
  }
  [[nodiscard]] WallView<Dim> wall_view() const { return {wall_specs, wall_shapes, walls, range}; }
};

/// Every so many steps comes what must not depend on when lists are rebuilt: positions go around
/// the ends of a periodic box, particles outside the domain are noticed, overlaps are looked at.
inline constexpr std::int64_t kEventSteps = 16;

/// What changes from step to step.
struct StepFrame {
  double kick = 0.0;       ///< half of the last step and half of this one: dt, at first dt/2 [s]
  double gravity[3] = {};  ///< [m/s²]
  double local_damping = 0.0;  ///< of the stage (Stage)
  std::int64_t step = 0;
  double last_dt = 0.0;  ///< of the step before: springs stretch over it [s]; in the first step 0
  [[nodiscard]] bool has_moved() const { return last_dt > 0.0; }
};

}  // namespace barchan
