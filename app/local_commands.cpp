#include <barchan/app/commands.hpp>
#include <barchan/app/verdict.hpp>

namespace barchan::app {

void run_local(const CommandLine& line) {
  if (line.kind == CommandKind::Check) return check_deck(line.check);
  if (line.kind == CommandKind::Info) return show_info(line.info_path);
  convert(line.convert);
}

void run_local_on_root(const Communicator& world, const CommandLine& line) {
  on_rank_zero(world, [&] { run_local(line); });
}

}  // namespace barchan::app
