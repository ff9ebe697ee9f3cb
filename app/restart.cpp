#include <barchan/app/restart.hpp>

#include <cstdio>
#include <filesystem>

#include <barchan/app/verdict.hpp>
#include <barchan/app/warning.hpp>
#include <barchan/core/base/error.hpp>

namespace fs = std::filesystem;

namespace barchan::app {
namespace {

/// Whether a checkpoint lies in the folder of this run, so that its results go on.
bool is_of(const RunFolder& folder, const std::string& checkpoint) {
  std::error_code ignored;
  const fs::path home = fs::weakly_canonical(folder.file("checkpoints"), ignored);
  return fs::weakly_canonical(checkpoint, ignored).parent_path() == home;
}

void tell(const Communicator& world, const CheckpointChoice& choice, bool is_quiet) {
  if (!world.is_root()) return;
  for (const std::string& reason : choice.skipped)
    std::fprintf(stderr, "barchan: warning: skipped a checkpoint: %s\n", reason.c_str());
  if (is_quiet) return;
  std::fprintf(stderr, "continuing from step %lld, %s\n", static_cast<long long>(choice.step),
               choice.path.c_str());
}

}  // namespace

RestartPoint restart_point(const Communicator& world, const RunArguments& arguments,
                           const RunFolder& folder) {
  RestartPoint point;
  const bool is_auto = arguments.restart == "auto";
  if (!arguments.restart.empty()) {
    if (arguments.options.exchange == "replay")
      throw InputError("--exchange replay cannot be combined with --restart",
                       "replay a run from its start");
    point.checkpoint =
        find_checkpoint(world, is_auto ? folder.file("checkpoints") : arguments.restart);
    if (!point.checkpoint && !is_auto) {
      throw InputError(
          SourcePlace{arguments.restart, 0, 0}, "there is no checkpoint",
          "give a checkpoint or a folder of them; without --restart a run begins at step 0");
    }
  }
  if (point.checkpoint) {
    point.continues = is_of(folder, point.checkpoint->path);
    tell(world, *point.checkpoint, arguments.quiet);
  }
  const bool was_cut_off = is_auto && !fs::exists(folder.file("run.json"));
  on_rank_zero(world, [&] { folder.check(arguments.force || point.continues || was_cut_off); });
  return point;
}

void print_warnings(Simulation& simulation, RunResults& results, Progress& progress) {
  auto warnings = simulation.take_checkpoint_warnings();
  for (const std::string& warning : warnings) results.log().add("warning: " + warning);
  for (std::string& warning : results.log().take_warnings()) warnings.push_back(std::move(warning));
  if (!warnings.empty()) progress.clear();
  for (const std::string& warning : warnings) print_warning(warning);
}

}  // namespace barchan::app
