// Resistance to rolling and twisting against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

constexpr double kPi = std::numbers::pi, kRadius = 0.01, kGravity = 9.81, kRolling = 0.01;
constexpr double kTangential = 1e5;

/// A sphere or disk, or a Hertz sphere, that lies on a floor.
struct Bed {
  std::string model;
  int dimension;
};

double mass_of(const Bed& bed) {
  return 2500.0 * kPi * kRadius * kRadius * (bed.dimension == 2 ? 1.0 : 4.0 / 3.0 * kRadius);
}

/// m r² / I
double gain(const Bed& bed) {
  return bed.dimension == 2 ? 2.0 : 2.5;
}

double young_star() {
  return 1e7 / (2.0 * 0.91);
}

/// Where the floor bears the weight.
double overlap_of(const Bed& bed) {
  const double weight = mass_of(bed) * kGravity;
  if (bed.model == "linear") return weight / 1e6;
  return std::pow(0.75 * weight / (young_star() * std::sqrt(kRadius)), 2.0 / 3.0);
}

std::string deck(const Bed& bed, double friction, const std::string& rules,
                 const std::string& rolling, const std::string& state, double rate = 400.0) {
  const bool is_flat = bed.dimension == 2;
  const std::string constants = bed.model == "linear"
                                    ? fmt::format(
                                          "normal_stiffness = 1e6\ntangential_stiffness = {}\n"
                                          "tangential_damping_rate = {}",
                                          kTangential, rate)
                                    : "young_modulus = 1e7\npoisson_ratio = 0.3\nrestitution = 0.5";
  return fmt::format(
      R"(
dimension = {}
gravity = {}
[domain]
lo = {}
hi = {}
[time]
step = 2e-6
steps = 100000000
[contact]
model = "{}"
{}
[[material]]
name = "m"
density = 2500.0
friction = {}
{}
{}
[[wall]]
name = "floor"
point = {}
normal = {}
material = "m"
[[particles]]
kind = "list"
material = "m"
particle = [{{ radius = {}, position = {}, {} }}]
)",
      bed.dimension, is_flat ? "[0.0, -9.81]" : "[0.0, -9.81, 0.0]",
      is_flat ? "[-1.0, -1.0]" : "[-1.0, -1.0, -1.0]", is_flat ? "[1.0, 1.0]" : "[1.0, 1.0, 1.0]",
      bed.model, rules, friction, constants, rolling, is_flat ? "[0.0, 0.0]" : "[0.0, 0.0, 0.0]",
      is_flat ? "[0.0, 1.0]" : "[0.0, 1.0, 0.0]", kRadius,
      fmt::format("[0.0, {:.17g}{}]", kRadius - overlap_of(bed), is_flat ? "" : ", 0.0"), state);
}

/// Rolls along x: omega about −z.
std::string rolls(const Bed& bed, double speed, double spin) {
  return bed.dimension == 2
             ? fmt::format("velocity = [{:.17g}, 0.0], omega = {:.17g}", speed, -spin)
             : fmt::format("velocity = [{:.17g}, 0.0, 0.0], omega = [0.0, 0.0, {:.17g}]", speed,
                           -spin);
}

const std::vector<Bed> kBeds{{"linear", 2}, {"linear", 3}, {"hertz", 3}};
constexpr const char* kSpring = "rolling = \"spring\"";

TEST(RollingResistance, SlowsABallDown) {
  for (const Bed& bed : kBeds) {
    auto simulation =
        test::simulate(deck(bed, 0.5, kSpring, "rolling_friction = 0.01\nrolling_stiffness = 1e3",
                            rolls(bed, 0.1, 0.1 / kRadius)));
    simulation.run(50000);
    const double before = test::particle(simulation, 1).velocity[0];
    simulation.run(100000);

    // M = R·mu_r·m·g turns it, friction moves it: m·a·(1 + I/(m r²)) = M/r
    const double wanted = kRolling * kGravity / (1.0 + 1.0 / gain(bed));
    EXPECT_NEAR((before - test::particle(simulation, 1).velocity[0]) / 0.2, wanted, 2e-4 * wanted)
        << bed.model << " " << bed.dimension;
  }
}

TEST(RollingResistance, SlowsASpinWithoutFriction) {
  for (const Bed& bed : kBeds) {
    auto simulation =
        test::simulate(deck(bed, 0.0, kSpring, "rolling_friction = 0.01\nrolling_stiffness = 1e3",
                            rolls(bed, 0.0, 20.0)));
    simulation.run(50000);
    const double before = test::particle(simulation, 1).omega[2];
    simulation.run(100000);

    const double wanted = gain(bed) * kRolling * kGravity / kRadius;
    EXPECT_NEAR((test::particle(simulation, 1).omega[2] - before) / 0.2, wanted, 1e-5 * wanted)
        << bed.model << " " << bed.dimension;
    EXPECT_EQ(test::particle(simulation, 1).velocity[0], 0.0);
  }
}

TEST(RollingResistance, RocksABallThatIsAboutToStop) {
  for (const Bed& bed : {Bed{"linear", 2}, Bed{"linear", 3}}) {
    const double kr = 1e3, mass = mass_of(bed), gain_of = gain(bed);
    const double inertia = mass * (1.0 + 1.0 / gain_of);
    auto simulation =
        test::simulate(deck(bed, 0.5, kSpring, "rolling_friction = 0.05\nrolling_stiffness = 1e3",
                            rolls(bed, 1e-4, 1e-4 / kRadius), 0.0));
    std::vector<double> turns;
    double before = -1.0;  // it rolls along x, about −z
    while (turns.size() < 3) {
      simulation.run(1);
      const double v = test::particle(simulation, 1).omega[2];
      if (v * before < 0.0) turns.push_back(2e-6 * static_cast<double>(simulation.step()));
      before = v;
    }

    // The tangential spring is in series: it bears kr·I/(I + m r²)-fold.
    const double share = gain_of / (1.0 + gain_of);
    const double half =
        kPi * std::sqrt(inertia / kr) * std::sqrt(1.0 + share * share * kr / kTangential);
    EXPECT_NEAR(0.5 * (turns[2] - turns[0]), half, 2e-3 * half) << bed.dimension;
  }
}

TEST(RollingResistance, StopsATwist) {
  for (const Bed& bed : {Bed{"linear", 3}, Bed{"hertz", 3}}) {
    auto simulation = test::simulate(deck(bed, 0.5, "twisting = \"marshall\"", "",
                                          "velocity = [0.0, 0.0, 0.0], omega = [0.0, 10.0, 0.0]"));
    simulation.run(10000);
    const double before = test::particle(simulation, 1).omega[1];
    simulation.run(20000);

    const double a = std::sqrt(kRadius * overlap_of(bed));
    const double wanted = 5.0 / 3.0 * a * 0.5 * kGravity / (kRadius * kRadius);
    EXPECT_NEAR((before - test::particle(simulation, 1).omega[1]) / 0.04, wanted, 1e-4 * wanted)
        << bed.model;
  }
}

/// How high the middle of a column of disks lies after it has collapsed beside a wall.
double height_of_heap(double rolling_friction) {
  const std::string rolling =
      rolling_friction > 0.0 ? fmt::format("rolling_friction = {}", rolling_friction) : "";
  auto simulation =
      test::simulate(fmt::format(R"(
dimension = 2
gravity = [0.0, -9.81]
[domain]
lo = [0.0, 0.0]
hi = [3.0, 1.0]
[time]
step = 5e-5
steps = 1000000
[contact]
{}
[[material]]
name = "grain"
density = 1000.0
normal_stiffness = 3e5
tangential_stiffness = 2e5
restitution = 0.4
friction = 0.5
{}
[[particles]]
kind = "packing"
region = {{ lo = [0.0, 0.0], hi = [0.4, 0.6] }}
radius = [0.012, 0.016]
solid_fraction = 0.75
material = "grain"
seed = 3
[[wall]]
name = "floor"
point = [0.0, 0.0]
normal = [0.0, 1.0]
material = "grain"
[[wall]]
name = "side"
point = [0.0, 0.0]
normal = [1.0, 0.0]
material = "grain"
)",
                                 rolling.empty() ? "" : "rolling = \"spring\"", rolling));
  simulation.run(30000);
  double sum = 0.0;
  int count = 0;
  simulation.for_each_owned([&](const OwnedParticle& p) { sum += p.position[1], ++count; });
  return sum / count;
}

TEST(RollingResistance, MakesAHeapSteeper) {
  const double without = height_of_heap(0.0), with_some = height_of_heap(0.1),
               with_more = height_of_heap(0.4);

  EXPECT_GT(with_some, 1.03 * without);
  EXPECT_GT(with_more, 1.05 * with_some);
}

}  // namespace
}  // namespace barchan
