// What the scripts beside this file run in the test suite: a step graph with contacts, bonds that
// break, a loaded plate and rebuilds, checkpoints written behind it, a restart, and a caller of the
// library; in 2D and 3D. A sanitizer watches, so little is compared.
#include <mpi.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <span>
#include <string>
#include <vector>

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

/// The same with excursions that are taken back, in which a caller does what it may.
std::uint64_t with_excursions(const test::Scenario& s, const RunOptions& options,
                              std::int64_t steps) {
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, options);
  State state;
  for (int k = 1; k <= 4; ++k) {
    sim.save(state);
    sim.run(9 * k);
    for (const LoadView& loads : sim.loads()) {
      for (std::size_t i = 0; i < loads.size(); ++i) loads.set(i, Vec3(0.1, 0.2, 0.0));
    }
    const auto views = sim.owned();
    sim.set_loads({views[0].ids(), std::vector<double>(3 * views[0].size(), 0.1), {}});
    sim.set_gravity(Vec3(0.0, -2.0 * k, 0.0));
    const std::vector<std::int64_t> one{s.set.particles[0].id};
    sim.scatter(ParticleField::Velocity, one, std::vector<double>(3, 0.0));
    sim.remove(one);
    sim.run(5);
    const auto arrays = sim.release_arrays();
    sim.run(5);
    try {
      sim.add(std::span(s.set.particles.data(), 1));
      sim.run(5);
    } catch (const InputError&) {  // there is another one by now
    }
    sim.load(state);
    sim.run(steps / 4);
  }
  return sim.digest();
}

bool is_same(const test::Scenario& s, const RunOptions& options, std::int64_t steps) {
  const std::uint64_t expected = whole(s, options, steps);
  const bool same =
      expected == in_parts(s, options, steps) && expected == with_excursions(s, options, steps);
  MPI_Barrier(MPI_COMM_WORLD);
  if (!same)
    std::fprintf(stderr, "%s: another digest after a restart or an excursion\n", s.name.c_str());
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
