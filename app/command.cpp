#include <barchan/app/command.hpp>

#include <cstdio>
#include <exception>

#include <barchan/app/command_line.hpp>
#include <barchan/app/commands.hpp>
#include <barchan/app/signals.hpp>
#include <barchan/app/verdict.hpp>
#include <barchan/comm/base/launcher.hpp>
#include <barchan/comm/base/mpi_session.hpp>

namespace barchan::app {
namespace {

int say(const CommandLine& line) {
  std::fputs(line.text.c_str(), line.status == kDone ? stdout : stderr);
  std::fflush(nullptr);
  return line.status;
}

void run_local(const CommandLine& line) {
  if (line.kind == CommandKind::Check) return check_deck(line.check);
  if (line.kind == CommandKind::Info) return show_info(line.info_path);
  if (line.kind == CommandKind::Sweep) return sweep(line.sweep);
  if (line.kind == CommandKind::Table) return print_runs(line.table);
  if (line.kind == CommandKind::Compare) return compare(line.compare);
  if (line.kind == CommandKind::Watch) return watch(line.watch);
  if (line.kind == CommandKind::Report) return report(line.report);
  convert(line.convert);
}

/// What one process does alone starts no MPI: it works where MPI does not. Among ranks the first
/// one does it, and the launcher passes on how it ended.
int run_alone(const CommandLine& line) {
  if (rank_by_launcher() > 0) return kDone;
  if (line.kind == CommandKind::Text) return say(line);
  return with_verdict(nullptr, [&] { run_local(line); });
}

/// Several processes that do not know of each other would all do the work, and print.
bool has_wrong_launcher(int world_size) {
  const LauncherMismatch mismatch = launcher_mismatch(world_size);
  if (mismatch && mismatch.is_first)
    std::fprintf(stderr, "barchan: %s (%s)\n", mismatch.what.c_str(), mismatch.remedy.c_str());
  return static_cast<bool>(mismatch);
}

}  // namespace

int run_barchan(int argc, char** argv) {
  keep_standard_streams();
  const CommandLine line = parse_command_line(argc, argv);
  if (line.kind != CommandKind::Run && line.kind != CommandKind::Probe) return run_alone(line);
  try {
    const MpiSession session(argc, argv);
    const Communicator world = Communicator::world();
    if (has_wrong_launcher(world.size())) return kWrongInput;
    return with_verdict(&world, [&] {
      if (line.kind == CommandKind::Run) return run_deck(world, line.run);
      probe(world, line.probe);
    });
  } catch (const std::exception& e) {
    std::fprintf(stderr, "barchan: %s\n", e.what());
    return kFailed;
  }
}

}  // namespace barchan::app
