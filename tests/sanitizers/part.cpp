// What the scripts beside this file run in the test suite: a step graph with contacts, bonds that
// break, a loaded plate and rebuilds, checkpoints written behind it, and a restart; in 2D and 3D. A
// sanitizer watches, so little is compared.
#include <mpi.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include <barchan/core/base/error.hpp>
#include <barchan/tasks/checkpoint_load.hpp>
#include <barchan/tasks/simulation.hpp>

#include "mpi/scenarios.hpp"

namespace {

using namespace barchan;

std::uint64_t whole(const test::Scenario& s, const RunOptions& options, std::int64_t steps) {
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, options);
  sim.run(steps);
  return sim.digest();
}

/// The same in two parts, over a checkpoint.
std::uint64_t in_parts(const test::Scenario& s, const RunOptions& options, std::int64_t steps) {
  const std::string folder = "checkpoints of " + s.name;
  CheckpointSpec spec;
  spec.every_steps = steps / 4;
  {
    Simulation sim(s.model, s.set, MPI_COMM_WORLD, options);
    sim.keep_checkpoints(folder, spec);
    sim.run(steps / 2 + 1);
    (void)sim.measure();
    if (!sim.finish_checkpoints()) throw RunError("no checkpoint was written");
  }
  const auto found = find_checkpoint(Communicator::world(), folder);
  if (!found) throw RunError("there is no checkpoint");
  Simulation sim = Simulation::restore(s.model, found->path, MPI_COMM_WORLD, options);
  sim.run(steps - sim.step());
  return sim.digest();
}

bool is_same(const test::Scenario& s, const RunOptions& options, std::int64_t steps) {
  const bool same = whole(s, options, steps) == in_parts(s, options, steps);
  MPI_Barrier(MPI_COMM_WORLD);
  if (!same) std::fprintf(stderr, "%s: another digest after a restart\n", s.name.c_str());
  return same;
}

}  // namespace

/// usage: sanitized_part THREADS EXCHANGE
int main(int argc, char** argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  RunOptions options;
  options.threads = argc > 1 ? std::atoi(argv[1]) : 2;
  if (argc > 2) options.exchange = argv[2];
  int status = 0;
  try {
    const bool same = is_same(test::soil_with_ring_and_plate(), options, 400) &&
                      is_same(test::breaking_plate(2), options, 200) &&
                      is_same(test::column_collapse(), options, 60);
    status = same ? 0 : 1;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
  return status;
}
