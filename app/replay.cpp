#include <barchan/app/replay.hpp>

#include <algorithm>
#include <array>
#include <cstdio>

#include <fmt/format.h>

#include <barchan/app/verdict.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/tasks/simulation.hpp>

namespace barchan::app {

RecordedRun record_run(const Communicator& world, const LoadedDeck& loaded,
                       const RunArguments& arguments, RunOptions& options) {
  options.tape = std::make_shared<Tape>();
  options.exchange = arguments.record;
  RecordedRun recorded;
  {
    Simulation simulation(loaded.deck.model, loaded.particles, world.duplicate(), options);
    try {
      simulation.run(loaded.deck.model.time.num_steps);
    } catch (const std::exception& e) {
      end_run(world, e, e.what());
    }
    (void)simulation.measure();  // takes in the last halo, as the end of the replay will
    const Timings timings = simulation.timings();
    recorded = {simulation.exchange_choice().name, simulation.step(), timings.loop_seconds,
                timings.exposed_seconds, simulation.digest()};
  }
  options.tape->rewind();
  options.exchange = "replay";
  return recorded;
}

void compare_replay(const Simulation& replay, const RecordedRun& recorded, std::uint64_t digest,
                    bool is_quiet) {
  if (digest != recorded.digest) {
    throw CommonError(
        fmt::format("the replay ended with digest {:016x}, the recorded run with {:016x}", digest,
                    recorded.digest));
  }
  const Communicator& world = replay.communicator();
  // Sums over ranks, in whole nanoseconds: exact in any order.
  std::array<std::int64_t, 3> sums{static_cast<std::int64_t>(1e9 * recorded.loop_seconds),
                                   static_cast<std::int64_t>(1e9 * replay.timings().loop_seconds),
                                   static_cast<std::int64_t>(1e9 * recorded.exposed_seconds)};
  world.allreduce_sum(std::span<std::int64_t>(sums));
  if (!world.is_root() || is_quiet) return;
  const auto per_step = [&](std::int64_t sum) {
    return 1e-3 * static_cast<double>(sum) /
           (world.size() * static_cast<double>(std::max<std::int64_t>(1, recorded.steps)));
  };
  const double with = per_step(sums[0]), without = per_step(sums[1]), exposed = per_step(sums[2]);
  std::printf(
      "Replay of %s: a step took %.4g µs with communication, %.4g µs without: %.4g µs exposed;\n"
      "the workers' own clocks measured %.4g µs (%.1f %% of the step apart). Digest equal.\n",
      recorded.exchange.c_str(), with, without, with - without, exposed,
      100.0 * (with - without - exposed) / with);
}

}  // namespace barchan::app
