#pragma once

#include <cstddef>
#include <string>

#include <barchan/core/particles/share.hpp>

namespace barchan {

/// What a share may refer to.
struct ShareLimits {
  int dimension = 2;
  std::size_t num_materials = 0, num_walls = 0, num_bond_laws = 0;
  int law = 0;  ///< of contact: its place in the list
};

/// Holds the columns of a share that came from a file against each other and against the model, so
/// that nothing that works on it can leave an array. Errors: InputError naming `file`.
void check_share(const CheckpointShare& share, const ShareLimits& limits, const std::string& file);

}  // namespace barchan
