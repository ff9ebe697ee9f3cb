#include <barchan/app/command.hpp>

#include <cstdio>
#include <exception>
#include <optional>

#include <barchan/app/command_line.hpp>
#include <barchan/app/commands.hpp>
#include <barchan/app/verdict.hpp>
#include <barchan/comm/mpi_session.hpp>

namespace barchan::app {
namespace {

void say(const CommandLine& line, bool is_root) {
  if (!is_root) return;
  std::fputs(line.text.c_str(), line.status == kDone ? stdout : stderr);
  std::fflush(nullptr);
}

/// Commands that need one process: on rank 0, and the others hear how it went.
int on_root(const Communicator* world, const CommandLine& line) {
  if (world == nullptr) return with_verdict(nullptr, [&] { run_local(line); });
  return with_verdict(world, [&] { run_local_on_root(*world, line); });
}

}  // namespace

int run_barchan(int argc, char** argv) {
  const CommandLine line = parse_command_line(argc, argv);
  const bool is_local = line.kind != CommandKind::Run && line.kind != CommandKind::Check &&
                        line.kind != CommandKind::Probe;
  // Among other ranks MPI must be joined even for a line of help, so that one of them prints.
  if (is_local && !is_started_as_rank()) {
    if (line.kind != CommandKind::Text) return on_root(nullptr, line);
    say(line, true);
    return line.status;
  }
  try {
    const MpiSession session(argc, argv);
    const Communicator world = Communicator::world();
    if (line.kind == CommandKind::Text) {
      say(line, world.is_root());
      return line.status;
    }
    if (line.kind == CommandKind::Run)
      return with_verdict(&world, [&] { run_deck(world, line.run); });
    if (line.kind == CommandKind::Probe)
      return with_verdict(&world, [&] { probe(world, line.probe); });
    return on_root(&world, line);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "barchan: %s\n", e.what());
    return kFailed;
  }
}

}  // namespace barchan::app
