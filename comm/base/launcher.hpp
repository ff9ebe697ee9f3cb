#pragma once

#include <string>

namespace barchan {

/// What is wrong when a launcher started several processes of which each takes itself for the only
/// one, because the launcher belongs to another MPI library; empty when nothing is.
struct LauncherMismatch {
  std::string what, remedy;
  bool is_first = true;  ///< of the processes that the launcher started, by the launcher's count

  explicit operator bool() const { return !what.empty(); }
};

/// Compares what launchers say in the environment with the size of MPI's world. Local.
[[nodiscard]] LauncherMismatch launcher_mismatch(int world_size);

}  // namespace barchan
