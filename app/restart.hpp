#pragma once

#include <optional>

#include <barchan/app/command_line.hpp>
#include <barchan/app/progress.hpp>
#include <barchan/tasks/checkpoint_load.hpp>
#include <barchan/tasks/results/run_folder.hpp>
#include <barchan/tasks/results/run_results.hpp>

namespace barchan::app {

/// Where a run begins.
struct RestartPoint {
  std::optional<CheckpointChoice> checkpoint;  ///< none: at step 0
  bool continues = false;                      ///< the results in the run's folder go on
};

/// Does what --restart says, and says on stderr which checkpoints it had to skip. `auto` begins at
/// step 0 when the folder has no checkpoint and no run has ended in it. Collective.
/// Errors: InputError: no checkpoint that verifies; a folder that may not be replaced.
[[nodiscard]] RestartPoint restart_point(const Communicator& world, const RunArguments& arguments,
                                         const RunFolder& folder);

/// Tells on stderr what the log warns of, and which checkpoints could not be written, if any.
/// Rank 0 has something to tell.
void print_warnings(Simulation& simulation, RunResults& results, Progress& progress);

}  // namespace barchan::app
