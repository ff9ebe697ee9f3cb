#pragma once

#include <cstddef>
#include <string>

#include <barchan/core/brick/energy_works.hpp>
#include <barchan/core/particles/share.hpp>

namespace barchan {

/// What a share may refer to.
struct ShareLimits {
  int dimension = 2;
  std::size_t num_materials = 0, num_walls = 0, num_bond_laws = 0;
  int law = 0;  ///< of contact: its place in the list
  bool has_heat = false;
  int num_carried = 0;  ///< numbers of a particle in fields of the caller's own
};

/// Of a share: broken bonds, the work of walls, and where energy has gone.
[[nodiscard]] constexpr std::size_t num_totals(std::size_t num_walls) {
  return 1 + (num_walls + EnergyWorks::kNumParts) * ExactSum::kDigits;
}

/// Holds the columns of a share that came from a file against each other and against the model, so
/// that nothing that works on it can leave an array. Errors: InputError naming `file`.
void check_share(const CheckpointShare& share, const ShareLimits& limits, const std::string& file);

}  // namespace barchan
