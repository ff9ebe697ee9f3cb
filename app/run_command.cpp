#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <barchan/app/commands.hpp>
#include <barchan/app/loaded_deck.hpp>
#include <barchan/app/progress.hpp>
#include <barchan/app/replay.hpp>
#include <barchan/app/restart.hpp>
#include <barchan/app/signals.hpp>
#include <barchan/app/summary_table.hpp>
#include <barchan/app/verdict.hpp>
#include <barchan/comm/base/leftovers.hpp>
#include <barchan/comm/base/watchdog.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/checkpoint/checkpoint_folder.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/exchange_setup.hpp>
#include <barchan/tasks/forecast.hpp>
#include <barchan/tasks/results/folder_claim.hpp>
#include <barchan/tasks/results/run_results.hpp>

namespace barchan::app {
namespace {

RunFolder folder_of(const RunArguments& arguments) {
  return arguments.out.empty() ? RunFolder::of_deck(arguments.deck) : RunFolder(arguments.out);
}

/// Whether a folder with files in it is looked at any further.
bool may_exist(const RunArguments& arguments) {
  return arguments.force || !arguments.restart.empty();
}

/// Everything that can be wrong with the input and is known before the engine: the same verdict on
/// all ranks.
LoadedDeck load(const Communicator& world, const RunArguments& arguments,
                std::optional<StepLimit>& limit) {
  LoadedDeck loaded;
  agree(world, [&] {
    loaded = load_deck(arguments.deck, arguments.settings);
    Model& model = loaded.deck.model;
    if (arguments.steps) model.time.num_steps = *arguments.steps;
    const auto limits = step_limits(model, loaded.particles);
    check_time_step(model, limits);
    check_precision(model, loaded.particles);
    if (!limits.empty()) limit = limits.front();
  });
  return loaded;
}

std::string with_last_checkpoint(const RunFolder& folder, const std::string& what) {
  const CheckpointFolder checkpoints(folder.file("checkpoints"));
  try {
    const auto steps = checkpoints.steps();
    if (!steps.empty()) return what + "; the last checkpoint is " + checkpoints.complete(steps[0]);
  } catch (const std::exception&) {  // a folder that cannot be read has nothing to offer
  }
  return what;
}

/// What there is when all ranks stop together: a row, a snapshot, and a checkpoint where the state
/// is sound. What cannot be written is left out; the error that ended the run is what matters.
void save_failed(Simulation& simulation, RunResults& results, const AgreedError& error) {
  results.log().add(std::string("error: ") + error.what());
  try {
    if (error.can_go_on()) simulation.save_checkpoint();
    (void)simulation.finish_checkpoints();
    results.write_failed();
  } catch (const std::exception& e) {
    results.log().add(std::string("error: ") + e.what());
  }
}

/// Steps, then what is due after them.
void advance_once(Simulation& simulation, RunResults& results, Progress& progress) {
  const std::int64_t end = simulation.model().time.num_steps;
  const std::int64_t due = std::min(results.next_step(), end) - simulation.step();
  simulation.run(std::min(due, progress.most_steps()));
  progress.update();
  print_warnings(simulation, results, progress);
  results.write();
}

void advance(Simulation& simulation, RunResults& results, const RunFolder& folder,
             Progress& progress) {
  const std::int64_t end = simulation.model().time.num_steps;
  try {
    while (simulation.step() < end && !simulation.stopped())
      advance_once(simulation, results, progress);
  } catch (const AgreedError& e) {
    progress.clear();
    save_failed(simulation, results, e);
    end_run(simulation.communicator(), e, with_last_checkpoint(folder, e.what()));
  } catch (const WaitError& e) {
    progress.clear();
    results.log().add(std::string("error: ") + e.what());
    end_waiting(simulation.communicator(), with_last_checkpoint(folder, e.what()));
  } catch (const std::exception& e) {
    progress.clear();
    results.log().add(std::string("error: ") + e.what());
    end_run(simulation.communicator(), e, with_last_checkpoint(folder, e.what()));
  }
  progress.clear();
}

void write_graph(const Simulation& simulation, const std::string& path) {
  const std::string dot = simulation.step_graph();
  on_rank_zero(simulation.communicator(), [&] {
    OutputFile file(path);
    file.write(dot);
    file.commit();
  });
}

/// The last state, where checkpoints are wanted or the run was interrupted. Before the results: a
/// signal may leave little time.
void save_last(Simulation& simulation, RunResults& results, Progress& progress, bool interrupted) {
  const CheckpointSpec& spec = simulation.model().checkpoint;
  if (interrupted || spec.every_steps > 0 || spec.every_seconds > 0.0) simulation.save_checkpoint();
  const bool is_saved = simulation.finish_checkpoints();
  print_warnings(simulation, results, progress);
  if (!is_saved && interrupted)
    throw CommonError("the run was interrupted and its last state could not be saved");
}

Simulation begin(const Communicator& world, const RunOptions& options, const LoadedDeck& loaded,
                 const RestartPoint& from) {
  const Model& model = loaded.deck.model;
  if (!from.checkpoint) return {model, loaded.particles, world.duplicate(), options};
  if (from.checkpoint->step > model.time.num_steps) {
    throw InputError(fmt::format("the checkpoint is of step {}, and the run has {} steps",
                                 from.checkpoint->step, model.time.num_steps),
                     "give more --steps or an earlier checkpoint");
  }
  return Simulation::restore(model, from.checkpoint->path, world.duplicate(), options);
}

}  // namespace

void run_deck(const Communicator& world, const RunArguments& arguments) {
  catch_early_signals();
  if (world.node_rank() == 0) remove_leftovers();
  check_exchange(arguments.options.exchange, world);
  check_exchange(arguments.record, world);
  const RunFolder folder = folder_of(arguments);
  std::optional<FolderClaim> claim;  // rank 0's; until all is written
  on_rank_zero(world, [&] { claim.emplace(folder, may_exist(arguments)); });
  const RestartPoint from = restart_point(world, arguments, folder);
  std::optional<StepLimit> limit;
  LoadedDeck loaded = load(world, arguments, limit);
  const Model& model = loaded.deck.model;
  RunOptions options = arguments.options;
  std::optional<RecordedRun> recorded;
  if (options.exchange == "replay") recorded = record_run(world, loaded, arguments, options);
  Simulation simulation = begin(world, options, loaded, from);
  if (!arguments.graph.empty()) write_graph(simulation, arguments.graph);
  const std::vector<Ring> rings = find_rings(loaded.deck.sources, loaded.begins, loaded.particles);
  catch_signals();
  RunResults results(simulation, folder, loaded.particles,
                     {arguments.deck, rings, limit, from.continues, loaded.deck.keys});
  if (claim && !claim->former().empty())
    results.log().add("took the folder over from " + claim->former() + ", which died");
  // A replay hears nothing from other ranks, so they cannot agree on a checkpoint.
  if (!recorded) simulation.keep_checkpoints(folder.file("checkpoints"), model.checkpoint);
  loaded.particles = {};

  Progress progress(simulation, arguments.quiet, folder.file("progress.json"));
  advance(simulation, results, folder, progress);
  const bool interrupted = simulation.step() < model.time.num_steps && !simulation.is_over();
  if (!recorded) save_last(simulation, results, progress, interrupted);
  const RunSummary summary = results.finish(interrupted);
  if (arguments.options.trace) simulation.write_trace(folder.file("trace.json"));
  if (world.is_root() && !arguments.quiet) print_summary(summary, folder, model);
  if (recorded) compare_replay(simulation, *recorded, simulation.digest(), arguments.quiet);
}

}  // namespace barchan::app
