// Beams of bonded particles against Euler and Bernoulli, thin-ring theory and free vibration.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kYoung = 1e8;    // [Pa]
constexpr double kRadius = 0.05;  // of disks, spheres and sections [m]
constexpr double kSpacing = 2.0 * kRadius;
constexpr double kRatio = 2.5;  // normal over shear stiffness

struct Section {
  double area, inertia;
};
Section section_of(int dimension) {
  if (dimension == 2) return {2.0 * kRadius, 2.0 / 3.0 * std::pow(kRadius, 3)};
  return {kPi * kRadius * kRadius, 0.25 * kPi * std::pow(kRadius, 4)};
}

/// A row of `num_bonds` + 1 bonded particles along x, the first one fixed at the origin.
std::string row_deck(int dimension, int num_bonds, double local_damping) {
  const bool is_flat = dimension == 2;
  const double end = kSpacing * num_bonds + 1.01 * kRadius;
  return fmt::format(
      R"(
dimension = {0}
[domain]
lo = {1}
hi = {2}
[time]
step = 4e-5
steps = 1000000
[[material]]
name = "beam"
density = 1000.0
normal_stiffness = 1e6
[[bond]]
name = "glue"
young_modulus = 1e8
damping_ratio = 0.1
[[particles]]
kind = "lattice"
region = {{ lo = {3}, hi = {4} }}
radius = 0.05
material = "beam"
bond = "glue"
fixed = {{ lo = {3}, hi = {5} }}
[[stage]]
name = "one"
local_damping = {6}
)",
      dimension, is_flat ? "[-1.0, -1.0]" : "[-1.0, -1.0, -1.0]",
      is_flat ? "[3.0, 1.0]" : "[3.0, 1.0, 1.0]",
      is_flat ? "[-0.05, -0.05]" : "[-0.05, -0.05, -0.05]",
      is_flat ? fmt::format("[{}, 0.051]", end) : fmt::format("[{}, 0.051, 0.051]", end),
      is_flat ? "[0.05, 0.05]" : "[0.05, 0.05, 0.05]", local_damping);
}

class Cantilever : public testing::TestWithParam<int> {};

TEST_P(Cantilever, SinksAtItsTipAsEulerAndBernoulliSay) {
  // N bonds bend at their middles, so a load P at the tip sinks it by P·l³/(3·E·I)·(1 − 1/(4·N²)),
  // and by N·P/ks more in shear.
  constexpr int kBonds = 10;
  const Section s = section_of(GetParam());
  const double length = kBonds * kSpacing;
  const double load =
      1e-3 * 3.0 * kYoung * s.inertia / (length * length);  // sinks 1e-3 of the length
  const double euler = load * std::pow(length, 3) / (3.0 * kYoung * s.inertia);
  const double shear = kBonds * load * kSpacing * kRatio / (kYoung * s.area);
  auto simulation = test::simulate(row_deck(GetParam(), kBonds, 0.6));
  ASSERT_EQ(simulation.num_particles(), kBonds + 1);

  const int axis = GetParam() - 1;
  Vec3 force = Vec3::Zero();
  force[axis] = -load;
  test::push(simulation, {{kBonds + 1, force}});
  simulation.run(60000);

  const double tip = -test::particle(simulation, kBonds + 1).position[axis];
  EXPECT_NEAR(tip, euler, 0.015 * euler);
  EXPECT_NEAR(tip, euler * (1.0 - 0.25 / (kBonds * kBonds)) + shear, 1e-4 * euler);
  EXPECT_LT(simulation.measure().kinetic.value(), 1e-7 * load * tip);
}

TEST_P(Cantilever, StretchesUnderAPullAlongIt) {
  constexpr int kBonds = 4;
  const double pull = 1e-4 * kYoung * section_of(GetParam()).area;
  auto simulation = test::simulate(row_deck(GetParam(), kBonds, 0.6));

  test::push(simulation, {{kBonds + 1, Vec3(pull, 0.0, 0.0)}});
  simulation.run(5000);

  const double stretch = test::particle(simulation, kBonds + 1).position[0] - kBonds * kSpacing;
  EXPECT_NEAR(stretch / (kBonds * kSpacing), 1e-4, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Cantilever, testing::Values(2, 3),
                         [](const auto& given) { return fmt::format("In{}D", given.param); });

TEST(Ring, FlattensBetweenTwoLoadsAsThinRingTheorySays) {
  // Timoshenko, Strength of Materials II: vertical diameter −(π/4 − 2/π)·P·R³/(E·I), horizontal
  // +(2/π − 1/2)·P·R³/(E·I). A section of half the disks' height keeps shear and stretching small.
  constexpr int kDisks = 48;
  constexpr double kRing = 1.0;
  const double height = kRing * std::sin(kPi / kDisks);
  const double stiffness = kYoung * std::pow(height, 3) / 12.0;
  const double load = 0.01 * stiffness / (kRing * kRing);
  auto simulation = test::simulate(fmt::format(R"(
dimension = 2
[domain]
lo = [-2.0, -2.0]
hi = [2.0, 2.0]
[time]
step = 5e-5
steps = 1000000
[[material]]
name = "duct"
density = 1000.0
normal_stiffness = 1e6
[[bond]]
name = "pipe"
young_modulus = 1e8
radius_factor = 0.5
damping_ratio = 0.1
[[particles]]
kind = "ring"
center = [0.0, 0.0]
radius = 1.0
count = {}
material = "duct"
bond = "pipe"
[[stage]]
name = "one"
local_damping = 0.6
)",
                                               kDisks));

  constexpr int kQuarter = kDisks / 4;
  test::push(simulation,
             {{1 + kQuarter, Vec3(0.0, -load, 0.0)}, {1 + 3 * kQuarter, Vec3(0.0, load, 0.0)}});
  simulation.run(60000);

  const auto at = [&](int quarter) {
    return test::particle(simulation, 1 + quarter * kQuarter).position;
  };
  const double unit = load * std::pow(kRing, 3) / stiffness;
  const double vertical = (at(1)[1] - at(3)[1] - 2.0 * kRing) / unit;
  const double horizontal = (at(0)[0] - at(2)[0] - 2.0 * kRing) / unit;
  RecordProperty("vertical", fmt::format("{:.5f}", vertical));
  RecordProperty("horizontal", fmt::format("{:.5f}", horizontal));
  EXPECT_NEAR(vertical, -(kPi / 4.0 - 2.0 / kPi), 0.01 * 0.1488);
  EXPECT_NEAR(horizontal, 2.0 / kPi - 0.5, 0.01 * 0.1366);
  EXPECT_LT(simulation.measure().kinetic.value(), 1e-7 * load * unit);
}

TEST(Twist, SwingsAtTheFrequencyOfAShaft) {
  // I·θ'' = −(G·J/L)·θ with I = 2/5·m·r², G = E/ratio: omega0 returns after one period.
  auto simulation = test::simulate(
      row_deck(3, 1, 0.0), {"bond.glue.damping_ratio=0.0", "particles.1.omega=[1e-3, 0.0, 0.0]"});
  const double mass = 4.0 / 3.0 * kPi * std::pow(kRadius, 3) * 1000.0;
  const double stiffness = kYoung / kSpacing / kRatio * 2.0 * section_of(3).inertia;
  const double omega = std::sqrt(stiffness / (0.4 * mass * kRadius * kRadius));
  const double dt = simulation.model().time.step;

  double error = 0.0;
  for (int k = 1; k <= 200; ++k) {
    simulation.run(1);
    const double exact = 1e-3 * std::cos(omega * (simulation.time() - 0.5 * dt));
    error = std::max(error, std::fabs(test::particle(simulation, 2).omega[0] - exact));
  }

  EXPECT_GT(200 * dt * omega, 2.0 * kPi);
  EXPECT_LT(error, 0.02e-3);
}

}  // namespace
}  // namespace barchan
