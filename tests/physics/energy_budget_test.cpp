// Where energy goes, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "physics_case.hpp"

namespace barchan {
namespace {

using test::particle;
using test::simulate;

const std::string kFloor = R"(
[domain]
lo = [-1.0, -1.0, 0.0]
hi = [9.0, 1.0, 3.0]
[output]
energy = true
[[wall]]
name = "floor"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
material = "m"
)";

const std::string kLinear = R"(
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
tangential_stiffness = 5e4
)";

const std::string kHertz = R"(
[contact]
model = "hertz"
[[material]]
name = "m"
density = 1000.0
young_modulus = 1e7
poisson_ratio = 0.25
)";

std::string ball(double z, const std::string& velocity) {
  return "[[particles]]\nkind = \"list\"\nmaterial = \"m\"\nparticle = [{ position = [0.0, 0.0, " +
         std::to_string(z) + "], velocity = " + velocity + ", radius = 0.1 }]\n";
}

std::string time(double step) {
  return "[time]\nstep = " + std::to_string(step) + "\nsteps = 1000000\n";
}

struct Balance {
  EnergyBudget budget;
  Measures measured;
  double kinetic, elastic;
};

Balance balance_of(Simulation& simulation) {
  const Measures m = simulation.measure();
  return {simulation.energy_budget(m), m, m.kinetic.value(), m.elastic.value()};
}

TEST(EnergyBudget, ContactsTakeWhatARestitutionSays) {
  for (const std::string& law : {kLinear, kHertz}) {
    Simulation run = simulate("dimension = 3\n" + time(2e-6) + kFloor + law +
                              "restitution = 0.6\n" + ball(0.1001, "[0.0, 0.0, -1.0]"));
    const Balance before = balance_of(run);
    EXPECT_EQ(before.budget.contact_loss, 0.0);
    run.run(20000);
    const Balance after = balance_of(run);
    EXPECT_EQ(after.measured.max_overlap, 0.0) << "it has rebounded";
    EXPECT_NEAR(after.budget.contact_loss, (1.0 - 0.36) * before.kinetic, 3e-3 * before.kinetic);
    EXPECT_NEAR(after.budget.error, 0.0, 1e-12 * before.kinetic);
  }
}

TEST(EnergyBudget, SlidingTakesTwoSeventhsUntilABallRolls) {
  Simulation run =
      simulate("dimension = 3\ngravity = [0.0, 0.0, -10.0]\n" + time(1e-5) + kFloor + kLinear +
               "friction = 0.5\ntangential_damping = 200.0\nrestitution = 0.2\n" +
               ball(0.0999, "[2.0, 0.0, 0.0]"));
  const Balance before = balance_of(run);
  run.run(60000);
  const Balance after = balance_of(run);
  EXPECT_NEAR(particle(run, 1).velocity[0], 2.0 * 5.0 / 7.0, 2e-3);
  EXPECT_NEAR(after.budget.contact_loss / before.kinetic, 2.0 / 7.0, 1e-3);
  EXPECT_NEAR(after.budget.error, 0.0, 1e-11 * before.kinetic);
}

TEST(EnergyBudget, GravityGivesWhatHeightLoses) {
  Simulation run = simulate("dimension = 3\ngravity = [0.0, 0.0, -10.0]\n" + time(1e-4) + kFloor +
                            kLinear + ball(2.0, "[0.3, 0.0, 0.0]"));
  const Balance before = balance_of(run);
  run.run(5000);
  const Balance after = balance_of(run);
  const double fallen =
      before.measured.gravitational.value() - after.measured.gravitational.value();
  EXPECT_NEAR(after.budget.gravity_work / fallen, 1.0, 1e-3);
  EXPECT_NEAR(after.budget.error, 0.0, 1e-11 * fallen);
}

TEST(EnergyBudget, CallersWallsAndLocalDampingHaveTheirShares) {
  const std::string deck = "dimension = 3\n" + time(1e-5) + kFloor + kLinear;
  Simulation run = simulate(deck + "[[stage]]\nname = \"slow\"\nlocal_damping = 0.3\n" +
                            ball(1.0, "[0.0, 0.0, 0.0]"));
  run.apply_forces([](const OwnedParticle& /*p*/) { return Vec3(10.0, 0.0, 0.0); });
  run.run(20000);
  const Balance after = balance_of(run);
  const double way = particle(run, 1).position[0];
  EXPECT_NEAR(after.budget.caller_work, 10.0 * way, 1e-3 * 10.0 * way);
  EXPECT_NEAR(after.budget.damping_loss, 0.3 * after.budget.caller_work,
              1e-9 * after.budget.caller_work);
  EXPECT_NEAR(after.kinetic, 0.7 * after.budget.caller_work, 1e-9 * after.kinetic);

  Simulation pushed =
      simulate(deck + ball(0.101, "[0.0, 0.0, 0.0]"), {"wall.floor.velocity=[0.0, 0.0, 1.0]"});
  pushed.run(20000);
  const Balance end = balance_of(pushed);
  EXPECT_NEAR(end.budget.wall_work / end.kinetic, 1.0, 2e-3) << "an elastic wall lifts it";
  EXPECT_NEAR(end.budget.contact_loss, 0.0, 2e-3 * end.kinetic);
}

TEST(EnergyBudget, BondsTakeWhatTheirDashpotsDo) {
  const std::string pair = R"(
dimension = 2
[time]
step = 1e-5
steps = 1000000
[domain]
lo = [-1.0, -1.0]
hi = [1.0, 1.0]
[output]
energy = true
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
[[bond]]
name = "glue"
normal_stiffness = 1e6
damping_ratio = 0.2
[[particles]]
kind = "ring"
center = [0.0, 0.0]
radius = 0.5
count = 24
material = "m"
bond = "glue"
)";
  Simulation run = simulate(pair);
  run.apply_forces([](const OwnedParticle& p) {
    return p.id == 1    ? Vec3(100.0, 0.0, 0.0)
           : p.id == 13 ? Vec3(-100.0, 0.0, 0.0)
                        : Vec3(Vec3::Zero());
  });
  run.run(2000);
  run.clear_forces();
  run.run(200000);
  const Balance after = balance_of(run);
  EXPECT_GT(after.budget.caller_work, 0.0);
  EXPECT_NEAR(after.budget.bond_loss + after.kinetic + after.elastic, after.budget.caller_work,
              1e-9 * after.budget.caller_work);
  EXPECT_GT(after.budget.bond_loss, 0.5 * after.budget.caller_work);
}

TEST(EnergyBudget, ClosesWhenACallerSetsVelocitiesAddsAndRemoves) {
  const std::string deck =
      "dimension = 3\n" + time(1e-4) + kFloor + kLinear + ball(1.0, "[1.0, 0.0, 0.0]");
  Simulation run = simulate(deck);
  const double start = balance_of(run).kinetic;  // at 1 m/s
  const std::vector<std::int64_t> first{1};
  ParticleData newcomer;
  newcomer.id = 2;
  newcomer.radius = 0.1;
  newcomer.density = 1000.0;
  newcomer.position = Vec3(3.0, 0.0, 1.0);
  newcomer.velocity = Vec3(-2.0, 0.0, 0.0);

  run.scatter(ParticleField::Velocity, first, std::vector<double>{3.0, 0.0, 0.0});
  EXPECT_NEAR(balance_of(run).budget.caller_work, (9.0 - 1.0) * start, 1e-12 * start);
  run.add(std::span(&newcomer, 1));
  EXPECT_NEAR(balance_of(run).budget.caller_work, (9.0 - 1.0 + 4.0) * start, 1e-12 * start);
  run.remove(first);
  run.run(10);
  const Balance after = balance_of(run);
  EXPECT_NEAR(after.budget.departed, 9.0 * start, 1e-12 * start);
  EXPECT_NEAR(after.kinetic, 4.0 * start, 1e-12 * start);
  EXPECT_NEAR(after.budget.error, 0.0, 1e-12 * start);

  Simulation fresh = simulate(deck);  // the account begins before the first change
  fresh.remove(first);
  EXPECT_NEAR(balance_of(fresh).budget.departed, start, 1e-12 * start);
  EXPECT_NEAR(balance_of(fresh).budget.error, 0.0, 1e-12 * start);
}

}  // namespace
}  // namespace barchan
