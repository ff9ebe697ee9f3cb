// Where energy goes, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
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
    EXPECT_NEAR(after.budget.dashpot_loss, (1.0 - 0.36) * before.kinetic, 3e-3 * before.kinetic);
    EXPECT_NEAR(after.budget.sliding_loss, 0.0, 1e-20);
    EXPECT_EQ(after.budget.rolling_loss, 0.0);
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
  EXPECT_NEAR(after.budget.sliding_loss / before.kinetic, 2.0 / 7.0, 1e-3);
  EXPECT_NEAR(after.budget.error, 0.0, 1e-11 * before.kinetic);
}

/// A ball on the floor, by linear and by Hertz contacts that resist rolling.
Simulation on_the_floor(bool is_hertz, const std::string& more, const std::string& state) {
  const std::string rules = "[contact]\nrolling = \"spring\"\n" + more;
  const std::string hertz =
      "model = \"hertz\"\n[[material]]\nname = \"m\"\ndensity = 1000.0\n"
      "young_modulus = 1e7\npoisson_ratio = 0.25\n";
  const std::string z = is_hertz ? "0.0999" : "0.09958";  // where it rests
  return simulate("dimension = 3\ngravity = [0.0, 0.0, -10.0]\n" + time(2e-5) + kFloor + rules +
                  (is_hertz ? hertz : kLinear) +
                  "friction = 0.5\nrestitution = 0.2\nrolling_friction = 0.02\n"
                  "[[particles]]\nkind = \"list\"\nmaterial = \"m\"\nparticle = [{ position = "
                  "[0.0, 0.0, " +
                  z + "], radius = 0.1, " + state + " }]\n");
}

TEST(EnergyBudget, ABallThatRollsLosesByRolling) {
  for (const bool is_hertz : {false, true}) {
    SCOPED_TRACE(is_hertz);
    Simulation run =
        on_the_floor(is_hertz, "", "velocity = [1.0, 0.0, 0.0], omega = [0.0, 10.0, 0.0]");
    run.run(1000);  // it settles
    const Balance before = balance_of(run);

    run.run(25000);

    const Balance after = balance_of(run);
    const double lost = after.budget.contact_loss - before.budget.contact_loss;
    EXPECT_NEAR(particle(run, 1).velocity[0] / (1.0 - 5.0 / 7.0 * 0.02 * 10.0 * 0.52), 1.0, 3e-3);
    EXPECT_GT(lost, 0.1 * before.kinetic);
    EXPECT_NEAR((after.budget.rolling_loss - before.budget.rolling_loss) / lost, 1.0, 3e-3);
  }
}

TEST(EnergyBudget, ABallThatSpinsLosesByTwisting) {
  for (const bool is_hertz : {false, true}) {
    SCOPED_TRACE(is_hertz);
    Simulation run =
        on_the_floor(is_hertz, "twisting = \"marshall\"\n", "omega = [0.0, 0.0, 10.0]");
    run.run(1000);
    const Balance before = balance_of(run);

    run.run(25000);

    const Balance after = balance_of(run);
    const double lost = after.budget.contact_loss - before.budget.contact_loss;
    EXPECT_GT(lost, 0.1 * before.kinetic);
    EXPECT_NEAR((after.budget.rolling_loss - before.budget.rolling_loss) / lost, 1.0, 3e-3);
  }
}

/// Balls on a grid that fly anywhere.
std::string gas(int dimension) {
  std::mt19937 draw(7);
  const auto number = [&] { return std::to_string(1e-6 * static_cast<double>(draw() % 1000000)); };
  const auto vector = [&](const auto& component) {
    std::string text = "[";
    for (int c = 0; c < dimension; ++c) text += (c > 0 ? ", " : "") + component(c);
    return text + "]";
  };
  std::string list;
  for (int cell = 0; cell < (dimension == 2 ? 25 : 125); ++cell) {
    const auto at = [&](int axis) {
      return std::to_string(0.1 + 0.2 * (cell / static_cast<int>(std::pow(5.0, axis) + 0.5) % 5));
    };
    const auto speed = [&](int /*axis*/) { return "-" + number(); };
    list += "{ position = " + vector(at) + ", radius = 0.0" + std::to_string(70 + cell % 20) +
            ", velocity = " +
            vector(cell % 2 == 0 ? std::function(speed) : [&](int /*axis*/) { return number(); }) +
            " },\n";
  }
  return "[[particles]]\nkind = \"list\"\nmaterial = \"m\"\nparticle = [\n" + list + "]\n";
}

/// A gas that loses by dashpots, sliding and rolling at once: what its contacts tell adds up.
void expect_parts_to_add_up(int dimension, const std::string& law) {
  const std::string third = dimension == 2 ? "" : ", 0.0", high = dimension == 2 ? "" : ", 1.0";
  const std::string axes = dimension == 2 ? "" : ", \"z\"";
  SCOPED_TRACE(law);
  Simulation run = simulate(
      "dimension = " + std::to_string(dimension) + "\n" + time(1e-5) + "[domain]\nlo = [0.0, 0.0" +
      third + "]\nhi = [1.0, 1.0" + high + "]\nperiodic = [\"x\", \"y\"" + axes +
      "]\n[output]\nenergy = true\n" + law +
      "friction = 0.4\nrolling_friction = 0.1\nrolling_damping = 0.5\nrestitution = 0.7\n" +
      gas(dimension));
  const Balance before = balance_of(run);

  run.run(dimension == 2 ? 40000 : 20000);

  const EnergyBudget b = balance_of(run).budget;
  EXPECT_GT(b.contact_loss, 0.1 * before.kinetic);
  EXPECT_GT(b.sliding_loss, 0.02 * b.contact_loss);
  EXPECT_GT(b.rolling_loss, 0.002 * b.contact_loss);
  EXPECT_NEAR((b.dashpot_loss + b.sliding_loss + b.rolling_loss) / b.contact_loss, 1.0, 3e-3);
}

TEST(EnergyBudget, PartsOfTheLossAddUp) {
  const std::string rolls = "[contact]\nrolling = \"spring\"\n";
  const std::string damped = "tangential_damping = 1.0\n";
  expect_parts_to_add_up(2, rolls + kLinear + damped);
  expect_parts_to_add_up(3, rolls + "twisting = \"marshall\"\n" + kLinear + damped);
  for (const char* tangential : {"mindlin", "mindlin-displacement"})
    expect_parts_to_add_up(3, rolls + "twisting = \"marshall\"\ntangential = \"" + tangential +
                                  "\"\nmodel = \"hertz\"\n[[material]]\nname = \"m\"\ndensity = "
                                  "1000.0\nyoung_modulus = 1e6\npoisson_ratio = 0.25\n");
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
