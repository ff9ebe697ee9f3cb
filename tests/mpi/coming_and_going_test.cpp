// What other solvers call between steps: particles that come and go.
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <barchan/core/base/error.hpp>

#include "coupling.hpp"

namespace barchan::test {
namespace {

TEST(Coupling, ParticlesThatAreAddedAreAsIfFromTheStart) {
  for (const int dimension : {2, 3}) {
    Scenario s = dragged(dimension);
    for (ParticleData& p : s.set.particles) p.radius = s.set.particles[0].radius;
    Simulation whole(s.model, s.set, MPI_COMM_SELF, with_threads(1));
    const auto half = static_cast<std::ptrdiff_t>(s.set.particles.size() / 2);
    const std::vector<ParticleData> later(s.set.particles.begin() + half, s.set.particles.end());
    s.set.particles.resize(static_cast<std::size_t>(half));
    Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(2));
    ASSERT_EQ(sim.force_grain(), whole.force_grain());
    sim.add(later);
    EXPECT_EQ(sim.num_particles(), whole.num_particles());
    EXPECT_EQ(sim.digest(), whole.digest());
    sim.run(s.num_steps);
    whole.run(s.num_steps);
    EXPECT_EQ(words_of(sim), words_of(whole));
  }
}

/// Some go and come back where there is room, some while checks are on their way.
void come_and_go(Simulation& sim, const std::vector<ParticleData>& away) {
  std::vector<std::int64_t> here;
  for (const ParticleData& p : away) here.push_back(p.id);
  for (int k = 0; k < 3; ++k) {
    sim.run(17 + k);
    const std::int64_t before = sim.num_particles();
    sim.remove(here);
    EXPECT_EQ(sim.num_particles(), before - static_cast<std::int64_t>(here.size()));
    here.clear();
    const State without = sim.save();
    for (const ParticleData& p : away) {
      try {
        sim.add(std::span(&p, 1));
        here.push_back(p.id);
      } catch (const InputError&) {  // there is another one
      }
    }
    EXPECT_FALSE(here.empty());
    sim.run(9);
    if (k != 1) continue;
    sim.load(without);
    here.clear();
    sim.run(5);
  }
}

TEST(Coupling, ParticlesComeAndGoAlikeOnAnyRanks) {
  for (Scenario s : {dragged(3), breaking_plate(2), plates_at_borders()}) {
    SCOPED_TRACE(s.name);
    s.model.output.energy = true;
    std::vector<ParticleData> away;
    for (std::size_t k = 0; k < s.set.particles.size(); k += 40) {
      away.push_back(s.set.particles[k]);
      away.back().velocity *= -1.0;
    }
    expect_same_on_any_ranks(s, [&](Simulation& sim) {
      sim.apply_forces([](const OwnedParticle& p) { return drag(p.velocity[0], 0.0, 0.0); });
      come_and_go(sim, away);
    });
  }
}

/// The lightest one that is there is on the last rank: the first one must know of it, too.
TEST(Coupling, TheStableStepOfNewcomersIsTheSameOnAnyRanks) {
  Scenario s = dragged(2);
  const auto last =
      std::max_element(s.set.particles.begin(), s.set.particles.end(),
                       [](const auto& p, const auto& q) { return p.position[0] < q.position[0]; });
  last->radius *= 0.25;
  ParticleData p = s.set.particles[0];
  p.id = 100000;
  p.position = last->position + Vec3(-2.0, 0.02, 0.0);
  p.radius = 1e-3;
  const auto touches = [&p](const ParticleData& q) {
    return (q.position - p.position).norm() < q.radius + p.radius;
  };
  while (std::any_of(s.set.particles.begin(), s.set.particles.end(), touches))
    p.position[0] += p.radius;
  Simulation alone(s.model, s.set, MPI_COMM_SELF, with_threads(1));
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(2));
  const auto words = [&](Simulation& of) {
    return words_thrown<InputError>([&] { of.add(std::span(&p, 1)); });
  };
  const std::string expected = words(alone);
  expect_words(expected, "is unstable: the limit is");
  EXPECT_EQ(words(sim), expected);
}

TEST(Coupling, RefusesParticlesThatCannotComeOrGo) {
  Scenario s = moving_walls();
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  sim.run(20);
  ParticleData p = s.set.particles[0];
  const auto words = [&] { return words_thrown<InputError>([&] { sim.add(std::span(&p, 1)); }); };
  expect_words(words(), "there is a particle " + std::to_string(p.id) + " already");
  p.id = 100000;
  sim.for_each_owned([&](const OwnedParticle& q) {
    if (q.id == s.set.particles[0].id) p.position = q.position;
  });
  MPI_Bcast(p.position.data(), 3, MPI_DOUBLE, 0, MPI_COMM_WORLD);
  p.velocity = p.omega = Vec3::Zero();
  if (num_ranks() == 1) expect_words(words(), "overlaps particle");
  p.position = Vec3(3.0, 0.9, 0.0);
  p.radius = 0.2;
  expect_words(words(), "more than cells of");
  p.radius = s.set.particles[0].radius;
  p.density = 1e-3;
  expect_words(words(), "time.step");
  p.density = 1000.0;
  p.position = Vec3(2.0, 1.0, 0.0);
  expect_words(words(), "on wall");
  p.position = Vec3(9.0, 0.5, 0.0);
  expect_words(words(), "outside the domain");
  const auto removal = [&](const std::vector<std::int64_t>& ids) {
    return words_thrown<InputError>([&] { sim.remove(ids); });
  };
  expect_words(removal({100000}), "there is no particle 100000");
  expect_words(removal({3, 3}), "named twice");
  EXPECT_EQ(sim.run(20), 20);
}

}  // namespace
}  // namespace barchan::test
