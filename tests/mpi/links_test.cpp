// Contacts and bonds with their forces, and walls that a caller puts elsewhere.
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include <barchan/core/base/error.hpp>

#include "coupling.hpp"

namespace barchan::test {
namespace {

using Record = std::array<double, 10>;

/// Of all ranks, sorted; on rank 0.
std::vector<Record> all_links(Simulation& sim, LinkKind kind) {
  std::vector<Record> mine;
  for (const LinkForce& l : sim.links(kind)) {
    mine.push_back({static_cast<double>(l.first), static_cast<double>(l.second), l.normal[0],
                    l.normal[1], l.normal[2], l.overlap, l.normal_force, l.tangential_force[0],
                    l.tangential_force[1], l.tangential_force[2]});
  }
  std::vector<Record> all = sim.communicator().gather_all(std::span<const Record>(mine));
  std::sort(all.begin(), all.end());
  return all;
}

TEST(Links, AreTheSameOnAnyRanks) {
  for (Scenario s : {breaking_plate(2), breaking_plate(3), plates_at_borders(), rolling_column(),
                     attracting_gas(true)}) {
    SCOPED_TRACE(s.name);
    Simulation alone(s.model, s.set, MPI_COMM_SELF, with_threads(1)),
        sim(s.model, s.set, MPI_COMM_WORLD, with_threads(2));
    for (const int steps : {0, 60}) {
      alone.run(steps);
      sim.run(steps);
      for (const LinkKind kind : {LinkKind::Contacts, LinkKind::WallContacts, LinkKind::Bonds}) {
        const auto expected = all_links(alone, kind), found = all_links(sim, kind);
        EXPECT_EQ(found, is_root() ? expected : std::vector<Record>{});
      }
    }
    EXPECT_EQ(words_of(sim), words_of(alone));  // who looks changes nothing
    EXPECT_EQ(static_cast<std::int64_t>(alone.links(LinkKind::Bonds).size()),
              alone.measure().bonds);
  }
}

/// A bond that breaks in the next step is listed without a force, and gives way to a contact.
bool breaks_next(Simulation& sim) {
  const State now = sim.save();
  const std::int64_t broken = sim.measure().broken_bonds;
  sim.run(1);
  const bool breaks = sim.measure().broken_bonds != broken;
  sim.load(now);
  return breaks;
}

/// m·dv = (sum of forces + m·g)·dt, with forces of contacts, walls and bonds.
TEST(Links, TheirForcesMoveParticles) {
  for (Scenario s : {breaking_plate(2), breaking_plate(3), rolling_column(), moving_walls()}) {
    SCOPED_TRACE(s.name);
    Simulation sim(s.model, s.set, MPI_COMM_SELF, with_threads(2));
    sim.run(50);
    while (breaks_next(sim)) sim.run(1);
    std::map<std::int64_t, Vec3> forces, velocities;
    std::int64_t count = 0;
    for (const LinkKind kind : {LinkKind::Contacts, LinkKind::WallContacts, LinkKind::Bonds}) {
      for (const LinkForce& l : sim.links(kind)) {
        const auto of = [&](std::int64_t id) -> Vec3& {
          return forces.try_emplace(id, Vec3::Zero()).first->second;
        };
        const Vec3 on_first = l.tangential_force - l.normal_force * l.normal;
        of(l.first) += on_first;
        if (kind != LinkKind::WallContacts) of(l.second) -= on_first;
        EXPECT_TRUE(kind == LinkKind::WallContacts || l.first < l.second);
        EXPECT_NEAR(l.normal.norm(), 1.0, 1e-12);
        ++count;
      }
    }
    ASSERT_GT(count, 0);
    sim.for_each_owned([&](const OwnedParticle& p) { velocities[p.id] = p.velocity; });
    const double dt = s.model.time.step, damping = s.model.stages[0].local_damping;
    ASSERT_EQ(damping, 0.0);
    sim.run(1);
    sim.for_each_owned([&](const OwnedParticle& p) {
      if (p.fixed) return;
      const auto found = forces.find(p.id);
      const Vec3 force = found == forces.end() ? Vec3(Vec3::Zero()) : found->second;
      const Vec3 dv = p.velocity - velocities[p.id] - dt * s.model.gravity;
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(dv[c], dt * force[c] / p.mass, 1e-9 * (1.0 + force.norm() * dt / p.mass));
    });
  }
}

/// Of all ranks.
void expect_one_wall_contact(Simulation& sim) {
  auto count = static_cast<std::int64_t>(sim.links(LinkKind::WallContacts).size());
  sim.communicator().allreduce_sum(std::span(&count, 1));
  EXPECT_EQ(count, 1);
}

TEST(Links, AWallThatIsPutIntoAParticlePressesIt) {
  Scenario s = two_particles(false);
  s.set.particles.resize(1);
  ParticleData& p = s.set.particles[0];
  p.velocity = Vec3::Zero();
  p.position = Vec3(1.9, 0.3, 0.0);
  add_wall(s.model, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  s.model.walls.back().name = "floor";
  const double kn = s.model.contacts.constants[0].kn, root = std::sqrt(0.5);
  expect_same_on_any_ranks(s, [&](Simulation& sim) {
    sim.run(20);
    sim.wall("floor").set_pose({1.9, 0.25, 0.0});
    EXPECT_EQ(sim.wall("floor").state().point[1], 0.25);
    expect_one_wall_contact(sim);
    for (const LinkForce& l : sim.links(LinkKind::WallContacts)) {
      EXPECT_EQ(l.first, p.id);
      EXPECT_EQ(l.second, 0);
      EXPECT_NEAR(l.overlap, 0.01, 1e-12);
      EXPECT_NEAR(l.normal_force, kn * 0.01, 1e-9 * kn);
      EXPECT_EQ(l.normal[1], -1.0);
    }
    EXPECT_GT(sim.measure().elastic.value(), 0.0);
    sim.wall("floor").set_pose({1.9, 0.3 - 0.055 / root, 0.0}, {2.0, 2.0, 0.0});
    expect_one_wall_contact(sim);
    for (const LinkForce& l : sim.links(LinkKind::WallContacts)) {
      EXPECT_NEAR(l.normal[0], -root, 1e-12);
      EXPECT_NEAR(l.overlap, 0.005, 1e-12);
    }
    const State pressed = sim.save();
    sim.wall("floor").set_pose({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
    EXPECT_TRUE(sim.links(LinkKind::WallContacts).empty());
    sim.load(pressed);
    sim.run(30);
  });
}

TEST(Links, WallsMayBePutElsewhereInTheCourse) {
  for (Scenario s : {moving_walls(), plates_at_borders()}) {
    SCOPED_TRACE(s.name);
    s.model.output.energy = true;
    const std::size_t w = s.model.walls.size() - 3;  // of plates the loaded one
    s.model.walls[w].name = "wall to move";
    const Vec3 point = s.model.walls[w].point, normal = s.model.walls[w].normal;
    expect_same_on_any_ranks(s, [&](Simulation& sim) {
      const auto put = [&](const Vec3& by, const Vec3& turned) {
        try {
          const Vec3 at = sim.wall("wall to move").state().point;
          sim.wall("wall to move").set_pose(at + by, normal + turned);
        } catch (const InputError& e) {
          expect_words(e.what(), "wall 'wall to move'");
        }
        sim.run(25);
      };
      sim.run(30);
      put(0.004 * normal, Vec3::Zero());
      put(-0.03 * normal, {0.01, 0.02, 0.0});
      put(-0.05 * normal, {0.0, 0.05, 0.0});
      EXPECT_NE(sim.wall("wall to move").state().point, point);
      EXPECT_LT(std::fabs(sim.energy_budget(sim.measure()).error),
                1e-6 * sim.measure().kinetic.value());
    });
  }
}

/// Stiffer, softer, without friction, with another dashpot; and back.
TEST(Links, ContactsMayChangeInTheCourse) {
  for (Scenario s : {rolling_column(), moving_walls(), hertz_column(), attracting_gas(true)}) {
    SCOPED_TRACE(s.name);
    s.model.output.energy = true;
    const std::string name = s.model.materials[0].name;
    const ContactConstants start = s.model.contacts.constants[0];
    expect_same_on_any_ranks(s, [&](Simulation& sim) {
      sim.run(40);
      ContactConstants pair = start;
      pair.kn *= 1.5, pair.young_star *= 1.2;
      pair.mu = 0.0;
      const State before = sim.save();
      sim.set_contact(name, name, pair);
      EXPECT_EQ(sim.contact(name, name).mu, 0.0);
      sim.run(20);
      sim.load(before);
      EXPECT_EQ(sim.contact(name, name).mu, start.mu);
      sim.run(10);
      pair.kn *= 0.5, pair.alpha *= 2.0;
      sim.set_contact(name, name, pair);
      sim.run(30);
    });
  }
}

TEST(Links, AContactThatIsSetIsThatOfTheModel) {
  const Scenario s = moving_walls();
  Scenario soft = s;
  for (ContactConstants& pair : soft.model.contacts.constants) pair.kn *= 0.999, pair.mu = 0.1;
  Simulation from_start(soft.model, s.set, MPI_COMM_WORLD, with_threads(1)),
      set(s.model, s.set, MPI_COMM_WORLD, with_threads(2));
  ASSERT_EQ(from_start.force_grain(), set.force_grain());
  set.set_contact("grain", "grain", soft.model.contacts.constants[0]);
  for (Simulation* sim : {&from_start, &set}) sim->run(200);
  EXPECT_EQ(words_of(set), words_of(from_start));
}

TEST(Links, RefusesContactsInWords) {
  const Scenario s = moving_walls();
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  ContactConstants pair = sim.contact("grain", "grain");
  const auto refused = [&] {
    return words_thrown<InputError>([&] { sim.set_contact("grain", "grain", pair); });
  };
  pair.kn = 1e15;
  expect_words(refused(), "is unstable");
  pair.kn = -1.0;
  expect_words(refused(), "normal_stiffness");
  pair.kn = is_root() ? 1e4 : 2e4;
  if (num_ranks() > 1) expect_words(refused(), "ranks give different");
  expect_words(words_thrown<std::invalid_argument>([&] { (void)sim.contact("grain", "gold"); }),
               "'grain'");
  EXPECT_EQ(sim.contact("grain", "grain").kn, s.model.contacts.constants[0].kn);
}

TEST(Links, RefusesPosesInWords) {
  Scenario s = moving_walls();
  s.model.walls[2].name = "floor";
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  sim.run(10);
  const std::uint64_t digest = sim.digest();
  const auto refused = [&](const Vec3& point, const Vec3& normal) {
    return words_thrown<InputError>([&] { sim.wall("floor").set_pose(point, normal); });
  };
  const Vec3 up(0.0, 1.0, 0.0);
  expect_words(refused({0.0, 0.5, 0.0}, up), "wall 'floor'");
  expect_words(refused({0.0, 0.0, 0.0}, Vec3::Zero()), "no length");
  expect_words(refused({0.0, 0.0, 1.0}, up), "leaves the plane");
  expect_words(refused({0.0, std::nan(""), 0.0}, up), "not finite");
  if (num_ranks() > 1)
    expect_words(refused({0.0, is_root() ? -0.1 : -0.2, 0.0}, up), "ranks give different");
  EXPECT_EQ(sim.digest(), digest);
  EXPECT_EQ(sim.wall("floor").state().point[1], 0.0);
}

}  // namespace
}  // namespace barchan::test
