// Steps of other lengths: a last one that is shorter, and another length from a step on.
#include <gtest/gtest.h>
#include <mpi.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include <barchan/core/base/error.hpp>

#include "coupling.hpp"

namespace barchan::test {
namespace {

TEST(StepLength, AdvancesToTheTimeItself) {
  const Scenario s = dragged(2);
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  const double dt = s.model.time.step;
  EXPECT_EQ(sim.advance_to(10.4 * dt), 11);
  EXPECT_EQ(sim.time(), 10.4 * dt);
  EXPECT_EQ(sim.advance_to(10.4 * dt), 0);
  EXPECT_EQ(sim.advance_to(12.9 * dt), 3);
  EXPECT_EQ(sim.time(), 12.9 * dt);
  EXPECT_EQ(sim.advance_to(14.9 * dt), 2);  // a rest of a rounding is no step
  expect_words(words_thrown<std::invalid_argument>([&] { sim.advance_to(2.0 * dt); }),
               "advance_to");
  const auto refused = [&](double time) {
    return words_thrown<InputError>([&] { sim.advance_to(time); });
  };
  expect_words(refused(std::nan("")), "advance_to");
  expect_words(refused(std::numeric_limits<double>::infinity()), "advance_to");
  if (num_ranks() > 1) {  // one that has passed on a single rank
    expect_words(refused((is_root() ? 2.0 : 20.0) * dt), "advance_to");
  }
}

TEST(StepLength, WholeStepsAreThoseOfRun) {
  const Scenario s = pushed_by_caller();
  Simulation by_steps(s.model, s.set, MPI_COMM_WORLD, with_threads(2)),
      by_time(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  by_steps.run(120);
  for (const double n : {1.0, 40.0, 41.0, 120.0}) by_time.advance_to(n * s.model.time.step);
  EXPECT_EQ(words_of(by_time), words_of(by_steps));
}

/// Leapfrog with kicks of half of either step beside it is exact under constant force.
TEST(StepLength, AFallKeepsToItsParabola) {
  Scenario s = two_particles(false);
  s.set.particles.resize(1);
  s.model.gravity = Vec3(0.0, -9.81, 0.0);
  const ParticleData start = s.set.particles[0];
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(2));
  const double dt = s.model.time.step;
  for (const double at : {0.3, 7.25, 7.5, 20.0, 33.01, 60.0}) {
    if (at == 20.0) sim.set_time_step(0.5 * dt);
    if (at == 60.0) sim.set_time_step(1.5 * dt);
    sim.advance_to(at * dt);
    const double t = at * dt;
    sim.for_each_owned([&](const OwnedParticle& p) {
      for (int c = 0; c < 2; ++c) {
        const double expected =
            start.position[c] + start.velocity[c] * t + 0.5 * s.model.gravity[c] * t * t;
        EXPECT_NEAR(p.position[c], expected, 1e-13);
      }
    });
  }
}

/// A collision in steps of any lengths loses as much energy as in equal ones, to the order of the
/// scheme, and springs along the contact stretch by the way that is gone.
TEST(StepLength, ACollisionIsThatOfEqualSteps) {
  Scenario s = two_particles(false);
  s.model.contacts.constants[0].cn.constant = 0.0;
  s.model.contacts.constants[0].mu = 0.4;
  const auto spin_after = [&](bool is_cut) {
    Simulation sim(s.model, s.set, MPI_COMM_SELF, with_threads(1));
    const double dt = s.model.time.step, end = 300.0 * dt;
    for (double at = 1.37; is_cut && at < 300.0; at += 1.37) sim.advance_to(at * dt);
    sim.advance_to(end);
    Vec3 speeds = Vec3::Zero();
    sim.for_each_owned([&](const OwnedParticle& p) {
      if (p.id == 3) speeds = Vec3(p.velocity[0], p.velocity[1], p.omega[2]);
    });
    return speeds;
  };
  const Vec3 equal = spin_after(false), cut = spin_after(true);
  ASSERT_GT(std::fabs(equal[2]), 1.0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(cut[c], equal[c], 2e-3 * std::fabs(equal[c]) + 1e-3);
}

/// With excursions, a wall that is driven, bonds that break, checks on their way.
TEST(StepLength, AnyLengthsGiveTheSameOnAnyRanks) {
  for (Scenario s : {dragged(3), breaking_plate(2), plates_at_borders(), rolling_column()}) {
    SCOPED_TRACE(s.name);
    s.model.output.energy = s.model.dimension == 2;
    const double dt = s.model.time.step;
    expect_same_on_any_ranks(s, [&](Simulation& sim) {
      sim.advance_to(13.7 * dt);
      sim.set_time_step(0.61 * dt);
      sim.advance_to(40.0 * dt);
      const State there = sim.save();
      sim.set_time_step(0.3 * dt);
      sim.advance_to(41.1 * dt);
      sim.load(there);
      EXPECT_EQ(sim.time(), 40.0 * dt);
      EXPECT_EQ(sim.model().time.step, 0.61 * dt);
      sim.run(20);
      sim.set_time_step(dt);
      sim.advance_to(90.5 * dt);
    });
  }
}

TEST(StepLength, ACheckpointKnowsTheTime) {
  const Scenario s = plates_at_borders();
  const double dt = s.model.time.step;
  const SharedFolder folder;
  Simulation first(s.model, s.set, MPI_COMM_WORLD, with_threads(2));
  first.keep_checkpoints(folder.path(), {});
  first.set_time_step(0.8 * dt);
  first.advance_to(30.3 * dt);
  first.save_checkpoint();
  ASSERT_TRUE(first.finish_checkpoints());
  Simulation second =
      Simulation::restore(first.model(), folder.at(first.step()), MPI_COMM_WORLD, with_threads(1));
  EXPECT_EQ(second.time(), 30.3 * dt);
  for (Simulation* sim : {&first, &second}) {
    sim->advance_to(50.0 * dt);
    sim->run(7);
  }
  EXPECT_EQ(first.time(), second.time());
  EXPECT_EQ(words_of(first), words_of(second));
}

/// A stage of 40 steps ends at its time, whatever the steps are.
TEST(StepLength, StagesEndAtTheirTime) {
  Scenario s = dragged(2);
  const double dt = s.model.time.step;
  s.model.stages = {Stage{}, Stage{}};
  s.model.stages[0].max_time = 40.0 * dt;
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(2));
  sim.advance_to(10.5 * dt);
  sim.set_time_step(0.5 * dt);
  sim.advance_to(39.0 * dt);
  sim.run(1);
  EXPECT_EQ(sim.stage(), 0);
  sim.run(2);
  EXPECT_EQ(sim.stage(), 1);
}

TEST(StepLength, RefusesWhatNoRunCouldTakeInWords) {
  const Scenario s = breaking_plate(2);
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  const auto refused = [&](double dt) {
    return words_thrown<InputError>([&] { sim.set_time_step(dt); });
  };
  sim.run(3);
  expect_words(refused(0.0), "above zero");
  expect_words(refused(-1e-5), "above zero");
  expect_words(refused(std::nan("")), "not finite");
  expect_words(refused(1.0), "is unstable");
  if (num_ranks() > 1) expect_words(refused(is_root() ? 1e-5 : 2e-5), "ranks give different");
  EXPECT_EQ(sim.model().time.step, s.model.time.step);
  if (num_ranks() > 1)
    expect_words(words_thrown<InputError>([&] { sim.advance_to(is_root() ? 1.0 : 2.0); }),
                 "ranks give different");
  EXPECT_EQ(sim.run(5), 5);
}

}  // namespace
}  // namespace barchan::test
