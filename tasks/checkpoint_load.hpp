#pragma once

#include <optional>
#include <string>
#include <vector>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/core/checkpoint/manifest.hpp>
#include <barchan/core/checkpoint/state.hpp>
#include <barchan/core/particles/share.hpp>
#include <barchan/core/search/grid.hpp>
#include <barchan/tasks/lane_map.hpp>

namespace barchan {

/// A checkpoint from which a run continues.
struct CheckpointChoice {
  std::string path;  ///< its folder
  std::int64_t step = 0;
  std::vector<std::string> skipped;  ///< newer checkpoints, and what is wrong with each
};

/// The newest checkpoint in `path` of which every byte verifies. @param path  a checkpoint (its
/// folder or manifest), a folder of checkpoints, or a run's folder. @return nothing when there is
/// none at all. Collective; ranks share the work. Errors: InputError when there are some but none
/// verifies, or the one that was named does not.
[[nodiscard]] std::optional<CheckpointChoice> find_checkpoint(const Communicator& communicator,
                                                              const std::string& path);

/// A checkpoint's contents but for the particles.
struct OpenCheckpoint {
  std::string path;
  Manifest manifest;
  CheckpointState state;
  [[nodiscard]] std::string file(std::size_t rank) const {
    return path + "/" + rank_file_name(rank);
  }
};

/// Reads what all ranks need. Collective. Errors: InputError: damaged, or of another model.
[[nodiscard]] OpenCheckpoint open_checkpoint(const Communicator& communicator,
                                             const std::string& path, const Model& model);

/// What the lanes of a rank get of a checkpoint.
struct LoadedShares {
  Cuts cuts;
  std::vector<CheckpointShare>
      shares;  ///< of this rank's lanes; contacts, bonds and walls of a cut in both neighbours
  std::vector<std::int64_t> totals;  ///< over the run
};

/// Deals the particles of a checkpoint to lanes, for equal counts. A rank reads the files that its
/// lanes need. Collective. Errors: InputError: damaged; particles missing; too many lanes for the
/// domain
template <int Dim>
[[nodiscard]] LoadedShares load_shares(const Communicator& communicator,
                                       const OpenCheckpoint& checkpoint, const Model& model,
                                       const Grid<Dim>& grid, const LaneMap& lanes);

}  // namespace barchan
