// States in memory: whoever goes back finds every bit as it was.
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <random>
#include <string>

#include <barchan/core/base/error.hpp>

#include "law_scenarios.hpp"
#include "running.hpp"

namespace barchan::test {
namespace {

/// To the end, with excursions at random steps that are taken back.
Words course_with_excursions(const Scenario& s, const RunOptions& options, unsigned seed) {
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, options);
  if (s.force) sim.apply_forces(s.force);
  std::mt19937 random(seed);
  const auto draw = [&random](int most) { return static_cast<std::int64_t>(random() % most); };
  State reused;
  while (sim.step() < s.num_steps && !sim.is_over()) {
    State outer = sim.save();
    sim.run(draw(20));
    sim.save(reused);
    sim.set_gravity({1.0, -20.0, 0.0});
    sim.apply_forces([](const OwnedParticle& p) { return Vec3(p.mass, -p.mass, 0.0); });
    sim.run(draw(40));
    if (draw(2) == 0) sim.load(reused);
    sim.load(outer);
    sim.run(std::min<std::int64_t>(1 + draw(60), s.num_steps - sim.step()));
  }
  return words_of(sim);
}

void expect_no_trace_of_excursions(const Scenario& s, unsigned seed) {
  SCOPED_TRACE(s.name);
  Simulation straight(s.model, s.set, MPI_COMM_SELF, with_threads(1));
  if (s.force) straight.apply_forces(s.force);
  straight.run(s.num_steps);
  const Words expected = words_of(straight);
  EXPECT_EQ(course_with_excursions(s, with_threads(1), seed), expected);
  EXPECT_EQ(course_with_excursions(s, with_threads(2, "isend"), seed + 1), expected);
}

TEST(State, AnExcursionThatIsTakenBackLeavesNoTrace) {
  unsigned seed = 1;
  for (Scenario s : {soil_with_ring_and_plate(), pushed_by_caller(), plates_at_borders(),
                     breaking_plate(2), breaking_plate(3), moving_walls(), hertz_column()}) {
    s.num_steps = std::min<std::int64_t>(s.num_steps, 240);
    s.model.output.energy = seed % 4 == 1;
    expect_no_trace_of_excursions(s, seed += 2);
  }
}

TEST(State, EveryExchangeCanGoBack) {
  Scenario s = pushed_by_caller();
  s.num_steps = 120;
  Simulation straight(s.model, s.set, MPI_COMM_SELF, with_threads(1));
  straight.apply_forces(s.force);
  straight.run(s.num_steps);
  const Words expected = words_of(straight);
  unsigned seed = 100;
  for (const std::string& exchange : exchange_choices())
    EXPECT_EQ(course_with_excursions(s, with_threads(1, exchange), ++seed), expected) << exchange;
}

TEST(State, GoesBackBehindAnErrorOfAllRanks) {
  Scenario s = two_particles(false);
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  sim.run(10);
  const State before = sim.save();
  const std::uint64_t digest = sim.digest();
  EXPECT_THROW(sim.run(6000), AgreedError);
  sim.load(before);
  EXPECT_EQ(sim.step(), 10);
  EXPECT_EQ(before.step(), 10);
  EXPECT_EQ(sim.digest(), digest);
  EXPECT_EQ(sim.run(20), 20);
}

}  // namespace
}  // namespace barchan::test
