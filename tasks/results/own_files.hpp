#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// Which files of a run's folder barchan wrote: by their names, and by how they begin.

namespace barchan {

/// What a run may remove, files before the folders that they lie in.
struct OwnFiles {
  std::vector<std::filesystem::path> files, folders;
};

/// All that earlier runs left in a run's folder. Other files are not listed. Reads only.
/// Errors: InputError, naming one, when a file that barchan did not write has the name of a result
/// or lies in a checkpoint, and when a file could not be removed.
[[nodiscard]] OwnFiles find_own_files(const std::string& folder);

/// Removes files, then the folders that are empty by then. Errors: filesystem_error.
void remove_files(const OwnFiles& own);

/// The step in the name of a snapshot, `step_000000500.pvtp`, or of a rank's piece of one,
/// `step_000000500_rank_0.vtp`.
[[nodiscard]] std::optional<std::int64_t> snapshot_step(const std::string& name);

}  // namespace barchan
