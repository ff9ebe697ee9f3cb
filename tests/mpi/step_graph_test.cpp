// A rank whose strip has room for one lane only, with more workers than that: chunk, left and right
// band run on different threads, and whoever is last has to see to the halo that is missing.
#include <gtest/gtest.h>
#include <mpi.h>

#include <barchan/tasks/strip_plan.hpp>

#include "running.hpp"
#include "scenarios.hpp"

namespace barchan::test {
namespace {

/// A gas in a box just long enough for so many strips of one lane.
Scenario narrow_gas(int num_strips, bool is_periodic) {
  Scenario s{"narrow gas", plain_model(2, 0.2, 0.3), {}, 1500, {}, false};
  s.model.domain.periodic[0] = is_periodic;
  do {
    s.model.domain.hi[0] += 0.05;
    s.set = {};
    add_cloud(s.set, 2, {s.model.domain.lo, s.model.domain.hi, 0.1, 0.053, 2.0, 27});
  } while (plan_cuts(s.model, s.set).room.most_strips() < num_strips);
  add_box_walls(s.model);
  shuffle_ids(s.set, 10);
  return s;
}

std::uint64_t digest_after(const Scenario& s, MPI_Comm comm, const RunOptions& options) {
  Simulation sim(s.model, s.set, comm, options);
  sim.run(s.num_steps);
  return sim.digest();
}

/// run() throws when a lane did not end its steps, so that one lost band in any step is seen.
void expect_all_bands(const std::string& exchange, bool is_periodic) {
  const Scenario s = narrow_gas(num_ranks(), is_periodic);
  RunOptions options;
  options.threads = 1;
  const std::uint64_t alone = digest_after(s, MPI_COMM_SELF, options);
  options.exchange = exchange;
  options.threads = 3;

  for (const double delay : {0.0, 2e-5}) {
    options.hooks.max_delay_seconds = delay;
    EXPECT_EQ(digest_after(s, MPI_COMM_WORLD, options), alone) << exchange << ", delay " << delay;
  }
}

TEST(StepGraph, DoesBothBandsOfALoneLaneWhenForcesAreReturned) {
  expect_all_bands("return", false);
  expect_all_bands("return", true);
}

TEST(StepGraph, DoesBothBandsOfALoneLaneWhenPositionsAreSentOnly) {
  expect_all_bands("put-flag", false);
}

}  // namespace
}  // namespace barchan::test
