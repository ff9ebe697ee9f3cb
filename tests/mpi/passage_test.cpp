// Fast particles meet others, plates and plates' ends: a contact, or an error that names both.
#include <gtest/gtest.h>
#include <mpi.h>

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>

#include "running.hpp"
#include "scenarios.hpp"

namespace barchan::test {
namespace {

constexpr double kRadius = 0.01, kDt = 1e-4;

ParticleData ball(std::int64_t id, const Vec3& position, const Vec3& velocity,
                  double radius = kRadius) {
  ParticleData p;
  p.id = id;
  p.radius = radius;
  p.density = 1000.0;
  p.position = position;
  p.velocity = velocity;
  return p;
}

/// A speed at which so many radii are passed in a step.
double speed_of(double radii) {
  return radii * kRadius / kDt;
}

/// An open box with a large particle far from everything, so that the skin is wide.
Scenario range(int dimension) {
  Scenario s{"range", plain_model(dimension, 8.0, 4.0), {}, 200, {}, false};
  s.model.walls.clear();
  s.model.time.step = kDt;
  s.model.domain.hi = Vec3(8.0, 4.0, dimension == 3 ? 4.0 : 0.0);
  s.model.contacts.constants[0].kn = dimension == 2 ? 1e7 : 1.5e5;
  s.model.domain.outside = OutsidePolicy::Delete;
  s.model.search.skin = 0.3;
  s.set.particles.push_back(ball(9, Vec3(7.0, 3.0, dimension == 3 ? 3.0 : 0.0), Vec3::Zero(), 0.4));
  return s;
}

Vec3 middle(const Scenario& s, double x, double y) {
  return {x, y, s.model.dimension == 3 ? 2.0 : 0.0};
}

struct Outcome {
  std::string error;
  Vec3 velocity = Vec3::Zero();  ///< of particle 1
};

Outcome outcome_of(const Scenario& s, int threads = 1) {
  Outcome outcome;
  Simulation sim(s.model, s.set, MPI_COMM_SELF, with_threads(threads));
  try {
    for (std::int64_t step = 0; step < s.num_steps; ++step) {
      sim.run(1);
      sim.for_each_owned([&](const OwnedParticle& p) {
        if (p.id == 1) outcome.velocity = p.velocity;
      });
    }
  } catch (const StepError& e) {
    outcome.error = e.what();
  }
  return outcome;
}

void expect_named(const Outcome& outcome, std::initializer_list<const char*> parts) {
  EXPECT_NE(outcome.error.find("has passed"), std::string::npos) << outcome.error;
  for (const char* part : parts)
    EXPECT_NE(outcome.error.find(part), std::string::npos) << outcome.error;
}

/// Two meet head on or off centre, by any number of radii a step: nobody goes through unnoticed.
/// @param offsets  of their lines, as a share of the sum of radii
void expect_nothing_in_silence(int dimension, double other_radius,
                               std::initializer_list<double> offsets) {
  int errors = 0, contacts = 0;
  for (const double radii : {0.3, 0.9, 1.1, 3.7, 9.0}) {
    for (const double offset : offsets) {
      for (int phase = 0; phase < 5; ++phase) {
        Scenario s = range(dimension);
        s.num_steps = static_cast<std::int64_t>(2.0 / radii / kRadius * 0.5) + 5;
        const double y = 2.0 + offset * (kRadius + other_radius);
        const double x = 1.0 + 0.21 * phase * radii * kRadius;
        s.set.particles.push_back(ball(1, middle(s, x, y), Vec3(speed_of(radii), 0, 0)));
        s.set.particles.push_back(ball(2, middle(s, 1.5, 2.0), Vec3::Zero(), other_radius));

        const Outcome outcome = outcome_of(s);

        const bool is_met = outcome.velocity != Vec3(speed_of(radii), 0, 0);
        EXPECT_TRUE(is_met || !outcome.error.empty())
            << radii << " radii a step, offset " << offset << ", phase " << phase;
        if (!outcome.error.empty()) expect_named(outcome, {"particle 1 at", "particle 2 at"});
        ++(outcome.error.empty() ? contacts : errors);
      }
    }
  }
  EXPECT_GT(errors, 10);
  EXPECT_GT(contacts, 10);
}

TEST(Passage, OfParticlesIsAContactOrAnErrorHoweverFastTheyAre) {
  expect_nothing_in_silence(2, kRadius, {0.0, 0.5, 0.9});
  expect_nothing_in_silence(2, 0.1, {0.0, 0.9});
  expect_nothing_in_silence(3, kRadius, {0.0, 0.7});
}

/// Shot at a plate between y = 1 and 3.
Scenario shot(int dimension, double radii, double y) {
  Scenario s = range(dimension);
  s.num_steps = static_cast<std::int64_t>(1.0 / radii / kRadius) + 5;
  WallSpec shield;
  shield.name = "shield";
  shield.kind = WallKind::Plate;
  shield.point = Vec3(1.5, 2.0, dimension == 3 ? 2.0 : 0.0);
  shield.normal = Vec3(-1.0, 0.0, 0.0);
  shield.width = 2.0;
  shield.depth = dimension == 3 ? 2.0 : 0.0;
  s.model.walls.push_back(shield);
  s.set.particles.push_back(ball(1, middle(s, 1.003, y), Vec3(speed_of(radii), 0, 0)));
  return s;
}

TEST(Passage, OfAPlateOrItsEndIsAContactOrAnErrorHoweverFastParticlesAre) {
  for (const int dimension : {2, 3}) {
    for (const double radii : {0.05, 0.3, 0.9, 1.1, 3.7, 9.0}) {
      for (const double y : {2.0, 3.0, 3.007}) {  // the face, the end, beside the end
        const Outcome outcome = outcome_of(shot(dimension, radii, y));

        const bool is_met = outcome.velocity != Vec3(speed_of(radii), 0, 0);
        EXPECT_TRUE(is_met || !outcome.error.empty()) << radii << " radii a step, y " << y;
        if (!outcome.error.empty()) expect_named(outcome, {"particle 1 at", "wall 'shield'"});
        const bool bounces = outcome.velocity[0] < 0.0 || !outcome.error.empty();
        EXPECT_TRUE(bounces || y != 2.0) << radii << " radii a step";
      }
    }
  }
}

TEST(Passage, OfAPlateThroughASoftContactIsAnErrorToo) {
  Scenario s = shot(2, 0.2, 2.0);
  s.model.contacts.constants[0].kn = 10.0;
  expect_named(outcome_of(s), {"wall 'shield'", "too soft to stop them", "normal_stiffness = "});
}

TEST(Passage, ByAPlateThatMovesIsAnError) {
  Scenario s = shot(2, 3.7, 2.0);
  s.set.particles.back().velocity.setZero();
  s.model.walls[0].velocity = Vec3(-speed_of(3.7), 0.0, 0.0);
  expect_named(outcome_of(s), {"particle 1 at", "wall 'shield'"});
}

TEST(Passage, AcrossAPeriodicFaceIsAnError) {
  // Behind the face; and right at it, where neither has been wrapped when the step ends.
  for (const auto& [right, left] : {std::pair{3.7, 2.1}, {3.1, 3.1}}) {
    Scenario s = range(2);
    s.model.domain.periodic[0] = true;
    s.num_steps = 20;  // before they meet once more, in the middle
    s.set.particles.push_back(ball(1, Vec3(7.8, 2.0, 0.0), Vec3(speed_of(right), 0, 0)));
    s.set.particles.push_back(ball(2, Vec3(0.2, 2.0, 0.0), Vec3(-speed_of(left), 0, 0)));
    expect_named(outcome_of(s), {"particle 1 at", "particle 2 at"});
  }
}

TEST(Passage, IsToldInTheSameWordsOnAnyNumberOfThreadsAndAfterAForceOfTheCaller) {
  std::optional<std::string> expected;
  for (const int threads : {1, 2, 3, 4}) {
    Scenario s = shot(2, 0.05, 2.0);
    Simulation sim(s.model, s.set, MPI_COMM_SELF, with_threads(threads));
    sim.apply_forces([](const OwnedParticle& p) {
      return Vec3(p.id == 1 ? p.mass * speed_of(3.7) / kDt : 0.0, 0.0, 0.0);
    });
    sim.run(1);
    sim.clear_forces();
    std::string error;
    try {
      sim.run(200);
    } catch (const StepError& e) {
      error = e.what();
    }
    EXPECT_NE(error.find("has passed wall 'shield'"), std::string::npos) << error;
    if (!expected) expected = error;
    EXPECT_EQ(error, *expected) << threads << " threads";
  }
}

TEST(Passage, WhatMovesAlikeMayBeAsFastAsItLikes) {
  Scenario s = range(2);
  s.num_steps = 20;
  const Vec3 velocity(speed_of(9.0), 0.0, 0.0);
  s.set.particles.push_back(ball(1, Vec3(1.0, 2.0, 0.0), velocity));
  s.set.particles.push_back(ball(2, Vec3(1.0199, 2.0, 0.0), velocity));
  EXPECT_EQ(outcome_of(s).error, "");
}

TEST(Passage, OfTwoThatAreBondedIsTheBondsBusiness) {
  Scenario s = range(2);
  s.num_steps = 4;
  s.model.bond_laws = {BondLaw{"soft", 1.0}};
  s.set.particles.push_back(ball(1, Vec3(1.0, 2.0, 0.0), Vec3(speed_of(3.7), 0, 0)));
  s.set.particles.push_back(ball(2, Vec3(1.05, 2.0, 0.0), Vec3::Zero()));
  expect_named(outcome_of(s), {"particle 1 at", "particle 2 at"});

  s.set.bonds = {{1, 2, 0}};
  EXPECT_EQ(outcome_of(s).error, "");
}

/// A cloud in free fall, so fast in the end that lists last for one step.
Scenario fast_fall() {
  Scenario s{"a fast fall", plain_model(2, 4.0, 20.0), {}, 800, {}, true};
  s.model.gravity = Vec3(1.5, -9.81, 0.0);
  s.model.time.step = 1e-3;
  s.model.contacts.constants[0].kn = 1e4;
  s.model.search.skin = 0.015;
  s.model.domain.outside = OutsidePolicy::Delete;
  add_cloud(s.set, 2, {{0.0, 15.0, 0.0}, {3.0, 19.0, 0.0}, 0.4, 0.05, 1.0, 3});
  return s;
}

TEST(ListsThatLastForAStep, GiveTheBitsOfOneRankOnAnyNumberOfRanksAndThreads) {
  const Scenario s = fast_fall();
  const auto digest = [&](MPI_Comm comm, const RunOptions& options) {
    Simulation sim(s.model, s.set, comm, options);
    sim.run(s.num_steps);
    EXPECT_GT(sim.measure().max_speed * s.model.time.step, 0.5 * *s.model.search.skin);
    return sim.digest();
  };
  const std::uint64_t expected = digest(MPI_COMM_SELF, with_threads(1));
  for (const int threads : {1, 2, 3})
    EXPECT_EQ(digest(MPI_COMM_WORLD, with_threads(threads)), expected) << threads;
}

/// Disks that touch, with springs, and part by more than the skin in a step; all pairs need no
/// lists.
TEST(ListsThatLastForAStep, LoseNoContactThatEndsAndFindAllThatAllPairsFind) {
  for (const bool is_periodic : {true, false}) {
    Scenario s{"a fast gas", plain_model(2, 6.0, 3.0), {}, 150, {}, false};
    s.model.domain.periodic = {is_periodic, is_periodic, false};
    s.model.domain.outside = OutsidePolicy::Delete;
    s.model.time.step = 1e-3;
    s.model.contacts.constants[0].kn = 1e5;
    s.model.time.allow_unstable = true;
    s.model.limits = {50.0, 100.0};
    s.model.search.skin = 0.002;
    add_cloud(s.set, 2, {{0.1, 0.1, 0.0}, {5.9, 2.9, 0.0}, 0.18, 0.04, 3.0, 7});
    RunOptions all_pairs = with_threads(1);
    all_pairs.search = ContactSearchKind::AllPairs;
    const Words expected = whole_run(s, MPI_COMM_SELF, all_pairs, 60, "").end;
    for (const int threads : {1, 3}) {
      const SharedFolder folder;
      EXPECT_EQ(whole_run(s, MPI_COMM_WORLD, with_threads(threads), 60, folder.path()).end,
                expected)
          << threads << " threads";
      Simulation sim = Simulation::restore(s.model, folder.at(60), MPI_COMM_WORLD, with_threads(2));
      sim.run(s.num_steps - 60);
      EXPECT_EQ(words_of(sim), expected) << "from a checkpoint";
    }
  }
}

TEST(ListsThatLastForAStep, GoOnFromACheckpointWithTheSameBits) {
  const Scenario s = fast_fall();
  const SharedFolder folder;
  for (const std::int64_t middle : {600, 601, 702}) {
    const Course whole = whole_run(s, MPI_COMM_WORLD, with_threads(2), middle, folder.path());
    Simulation sim =
        Simulation::restore(s.model, folder.at(middle), MPI_COMM_WORLD, with_threads(1));
    sim.run(s.num_steps - middle);
    EXPECT_EQ(words_of(sim), whole.end) << "from step " << middle;
  }
}

}  // namespace
}  // namespace barchan::test
