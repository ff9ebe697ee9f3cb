// Bonds break at their strength, and what they held apart collides from then on.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

constexpr double kRadius = 0.05;

/// Two bonded particles, one above the other; the lower one is fixed.
std::string pair_deck(int dimension, const std::string& strength) {
  const bool is_flat = dimension == 2;
  return fmt::format(R"(
dimension = {0}
[domain]
lo = {1}
hi = {2}
[time]
step = 2e-5
steps = 1000000
[[material]]
name = "rock"
density = 1000.0
normal_stiffness = 1e5
normal_damping_rate = 200.0
[[bond]]
name = "glue"
young_modulus = 1e8
damping_ratio = 0.7
{3}
[[particles]]
kind = "lattice"
region = {{ lo = {4}, hi = {5} }}
radius = 0.05
material = "rock"
bond = "glue"
fixed = {{ lo = {4}, hi = {6} }}
)",
                     dimension, is_flat ? "[-1.0, -1.0]" : "[-1.0, -1.0, -1.0]",
                     is_flat ? "[1.0, 1.0]" : "[1.0, 1.0, 1.0]", strength,
                     is_flat ? "[-0.05, -0.05]" : "[-0.05, -0.05, -0.05]",
                     is_flat ? "[0.051, 0.151]" : "[0.051, 0.051, 0.151]",
                     is_flat ? "[0.05, 0.05]" : "[0.05, 0.05, 0.05]");
}

double area(int dimension) {
  return dimension == 2 ? 2.0 * kRadius : std::numbers::pi * kRadius * kRadius;
}

/// Raises the force on the upper particle slowly. @return its size over area when the bond breaks
double stress_at_break(Simulation& simulation, int axis, double expected) {
  const double a = area(simulation.model().dimension);
  for (double share = 0.0; share < 1.1; share += share < 0.9 ? 0.02 : 0.002) {
    Vec3 force = Vec3::Zero();
    force[axis] = share * expected * a;
    test::push(simulation, {{2, force}});
    simulation.run(300);
    if (simulation.measure().broken_bonds > 0) return share * expected;
  }
  return 0.0;
}

class Strength : public testing::TestWithParam<int> {};

TEST_P(Strength, HoldsUpToTheTensileStrengthAndNoFurther) {
  auto simulation = test::simulate(pair_deck(GetParam(), "tensile_strength = 1e4"),
                                   {"stage=[{name='one', local_damping=0.5}]"});

  const double broke = stress_at_break(simulation, GetParam() - 1, 1e4);

  EXPECT_NEAR(broke, 1e4, 0.003 * 1e4);
  EXPECT_EQ(simulation.measure().bonds, 0);
}

TEST_P(Strength, HoldsUpToTheShearStrengthAndNoFurther) {
  auto simulation = test::simulate(pair_deck(GetParam(), "shear_strength = 1e4"),
                                   {"stage=[{name='one', local_damping=0.5}]"});

  const double broke = stress_at_break(simulation, 0, 1e4);

  EXPECT_NEAR(broke, 1e4, 0.003 * 1e4);
}

TEST_P(Strength, CountsBendingInTension) {
  // A side load F bends the bond with F·L/2 at its middle: M·R/I = F/A·(L/2)·R·A/I.
  auto simulation = test::simulate(pair_deck(GetParam(), "tensile_strength = 1e4"),
                                   {"stage=[{name='one', local_damping=0.5}]"});
  const double radius_gain = GetParam() == 2 ? 3.0 : 4.0;  // A·R²/I

  const double broke = stress_at_break(simulation, 0, 1e4 / radius_gain);

  EXPECT_NEAR(broke, 1e4 / radius_gain, 0.005 * 1e4 / radius_gain);
}

TEST_P(Strength, LeavesAnOrdinaryContactBehind) {
  // Thrown up hard enough to break free, it falls back onto the lower one and rests there.
  const bool is_flat = GetParam() == 2;
  auto simulation = test::simulate(
      pair_deck(GetParam(), "tensile_strength = 1e4"),
      {is_flat ? "particles.1.velocity=[0.0, 1.0]" : "particles.1.velocity=[0.0, 0.0, 1.0]",
       is_flat ? "gravity=[0.0, -9.81]" : "gravity=[0.0, 0.0, -9.81]"});
  simulation.run(2000);
  ASSERT_EQ(simulation.measure().broken_bonds, 1);
  ASSERT_EQ(simulation.measure().contacts, 0);

  simulation.run(30000);

  const OwnedParticle upper = test::particle(simulation, 2);
  const double overlap = 2.0 * kRadius - upper.position[GetParam() - 1];
  EXPECT_EQ(simulation.measure().contacts, 1);
  EXPECT_NEAR(overlap, upper.mass * 9.81 / 1e5, 1e-3 * overlap);
}

/// Two bonded spheres turn against each other about the line between them.
/// @return whether they break
bool breaks_twisted(double spin) {
  auto simulation = test::simulate(fmt::format(R"(
dimension = 3
[domain]
lo = [-1.0, -1.0, -1.0]
hi = [1.0, 1.0, 1.0]
[time]
step = 2e-6
steps = 1000000
[[material]]
name = "rock"
density = 1000.0
normal_stiffness = 1e5
[[bond]]
name = "glue"
young_modulus = 1e8
shear_strength = 1e4
[[particles]]
kind = "list"
material = "rock"
bond = "glue"
particle = [
  {{ position = [0.0, 0.0, 0.0], omega = [0.0, 0.0, {}], radius = 0.05 }},
  {{ position = [0.0, 0.0, 0.1], omega = [0.0, 0.0, {}], radius = 0.05 }},
])",
                                               spin, -spin));
  simulation.run(1000);
  return simulation.measure().broken_bonds > 0;
}

TEST(TwistStrength, CountsTwistInShear) {
  // Undamped, the moment swings up to 2·spin·sqrt(k·I/2), k = E/(2.5·L)·J, and the stress is M·R/J.
  const double polar = 0.5 * std::numbers::pi * std::pow(kRadius, 4);
  const double k = 1e8 / (2.5 * 2.0 * kRadius) * polar;
  const double inertia = 0.4 * 1000.0 * 4.0 / 3.0 * std::numbers::pi * std::pow(kRadius, 5);
  const double spin = 1e4 * polar / kRadius / (2.0 * std::sqrt(0.5 * k * inertia));

  EXPECT_FALSE(breaks_twisted(0.995 * spin));
  EXPECT_TRUE(breaks_twisted(1.005 * spin));
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Strength, testing::Values(2, 3),
                         [](const auto& given) { return fmt::format("In{}D", given.param); });

}  // namespace
}  // namespace barchan
