#pragma once

#include <string>

#include <barchan/app/command_line.hpp>
#include <barchan/app/loaded_deck.hpp>
#include <barchan/comm/base/communicator.hpp>
#include <barchan/tasks/simulation.hpp>

namespace barchan::app {

/// A run whose messages were recorded on this rank.
struct RecordedRun {
  std::string exchange;
  std::int64_t steps = 0;
  double loop_seconds = 0.0, exposed_seconds = 0.0;
  std::uint64_t digest = 0;
};

/// For `--exchange replay`: runs the deck once without results, records all messages on a tape, and
/// makes `options` those of the replay. Collective. Errors: as of a run.
[[nodiscard]] RecordedRun record_run(const Communicator& world, const LoadedDeck& loaded,
                                     const RunArguments& arguments, RunOptions& options);

/// Prints on rank 0 what the recorded run took more than its replay, and what its own clocks called
/// exposed. Collective. Errors: RunError, the same on every rank, when the replay ended otherwise.
void compare_replay(const Simulation& replay, const RecordedRun& recorded, std::uint64_t digest,
                    bool is_quiet);

}  // namespace barchan::app
