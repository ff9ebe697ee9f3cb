// Loaded plates: they make no energy, are second order, and stand on whatever is there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <barchan/tasks/stability.hpp>

#include "physics_case.hpp"

namespace barchan {
namespace {

/// A piston at rest on one elastic disk that lies on the floor; nothing damps.
std::string piston_deck(double mass, double velocity, const std::string& more = "") {
  return fmt::format(R"(
dimension = 2
[domain]
lo = [-1.0, -0.1]
hi = [1.0, 1.0]
[time]
step = 1e-4
steps = 60000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e6
[[particles]]
kind = "list"
material = "m"
particle = [ {{ position = [0.0, 0.0999], radius = 0.1 }} ]
{}
[[wall]]
name = "floor"
point = [0.0, 0.0]
normal = [0.0, 1.0]
material = "m"
[[wall]]
name = "piston"
kind = "plate"
point = [0.0, 0.1998]
normal = [0.0, -1.0]
width = 1.0
load = 100.0
mass = {}
velocity = [0.0, {}]
material = "m"
)",
                     more, mass, velocity);
}

struct Extent {
  double lo = 1e300, hi = -1e300;
  void take(double x) { lo = std::min(lo, x), hi = std::max(hi, x); }
  [[nodiscard]] double width() const { return hi - lo; }
};

double height_of_piston(const Simulation& simulation) {
  return simulation.walls()[1].point[1];
}

Extent bounce(Simulation& simulation, int steps) {
  Extent extent;
  for (int k = 0; k < steps; ++k) {
    simulation.run(1);
    extent.take(height_of_piston(simulation));
  }
  return extent;
}

double smallest_limit(const std::string& deck) {
  const Deck read = parse_deck(deck, "test.toml");
  return step_limits(read.model, make_particles(read.model, read.sources)).front().step;
}

/// Amplitude over the last sixth of 60,000 steps against that of the first.
void expect_constant_amplitude(const std::string& deck, double share) {
  const double step = share * smallest_limit(deck);
  auto simulation = test::simulate(deck, {fmt::format("time.step={}", step)});

  const double first = bounce(simulation, 10000).width();
  simulation.run(40000);
  const double last = bounce(simulation, 10000).width();

  EXPECT_GT(first, 1e-6);
  EXPECT_NEAR(last / first, 1.0, 0.01) << deck << "step " << step;
}

TEST(Plate, BouncesOnADiskWithTheSameAmplitudeForEver) {
  for (const double share : {0.04, 0.2}) {
    expect_constant_amplitude(piston_deck(200.0, 0.002), share);
    expect_constant_amplitude(piston_deck(2.0, 0.002), share);  // lighter than the disk
  }
  // It comes off the disk, and back.
  expect_constant_amplitude(piston_deck(200.0, -0.05, "fixed = true"), 0.04);
}

TEST(Plate, BouncesOnAFixedDiskAsAWeightOnASpringDoes) {
  const std::string deck = piston_deck(200.0, 0.002, "fixed = true");
  const double step = 0.04 * smallest_limit(deck);
  auto simulation = test::simulate(deck, {fmt::format("time.step={}", step)});
  const double omega = std::sqrt(1e6 / 200.0);

  for (int k = 0; k < 60000; ++k) {
    simulation.run(1);
    const double t = step * static_cast<double>(k + 1);
    if (k % 1000 != 0 || omega * t > 20.0) continue;
    ASSERT_NEAR(height_of_piston(simulation), 0.1998 + 0.002 / omega * std::sin(omega * t), 4e-7);
  }
  const double last = bounce(simulation, 10000).width();

  EXPECT_NEAR(last, 2.0 * 0.002 / omega, 0.01 * 0.004 / omega);
}

TEST(Plate, IsOfSecondOrder) {
  const std::string deck = piston_deck(200.0, 0.002, "fixed = true");
  const double omega = std::sqrt(1e6 / 200.0), t = 0.064;
  const auto error = [&](double step) {
    auto simulation = test::simulate(deck, {fmt::format("time.step={}", step)});
    simulation.run(std::lround(t / step));
    return height_of_piston(simulation) - 0.1998 - 0.002 / omega * std::sin(omega * t);
  };
  const double coarse = error(1e-3), fine = error(5e-4);

  EXPECT_NEAR(coarse / fine, 4.0, 0.2);
}

TEST(Plate, ThatAppearsLaterIsOfSecondOrderToo) {
  std::string deck = piston_deck(200.0, 0.002, "fixed = true");
  deck +=
      "from_stage = \"load\"\n[[stage]]\nname = \"wait\"\nmax_time = 0.01\n"
      "[[stage]]\nname = \"load\"\n";
  const double omega = std::sqrt(1e6 / 200.0), t = 0.064;
  const auto error = [&](double step) {
    auto simulation = test::simulate(deck, {fmt::format("time.step={}", step)});
    simulation.run(std::lround((0.01 + t) / step));
    return height_of_piston(simulation) - 0.1998 - 0.002 / omega * std::sin(omega * t);
  };

  EXPECT_NEAR(error(1e-3) / error(5e-4), 4.0, 0.2);
}

/// A plate without load between two disks.
std::string squeezed(const std::string& particles, double mass, double velocity) {
  return fmt::format(R"(
dimension = 2
[domain]
lo = [-1.0, -1.0]
hi = [1.0, 1.0]
[time]
step = 1e-5
steps = 100000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e6
[[particles]]
kind = "list"
material = "m"
{}
[[wall]]
name = "plate"
kind = "plate"
point = [0.0, 0.0]
normal = [0.0, -1.0]
width = 0.3
load = 0.0
mass = {}
velocity = [0.0, {}]
material = "m"
)",
                     particles, mass, velocity);
}

TEST(Plate, BetweenTwoFixedDisksFeelsBoth) {
  auto simulation =
      test::simulate(squeezed("particle = [ { position = [0.1, 0.0999], radius = 0.1 },"
                              "{ position = [-0.05, -0.0499], radius = 0.05 } ]\nfixed = true",
                              50.0, 0.01));
  const double omega = std::sqrt(2e6 / 50.0);
  Extent extent;
  for (int k = 0; k < 30000; ++k) {
    simulation.run(1);
    const double y = simulation.walls()[0].point[1];
    extent.take(y);
    if (k % 300 == 0) {
      EXPECT_NEAR(y, 0.01 / omega * std::sin(omega * 1e-5 * (k + 1)), 2e-8);
    }
  }
  EXPECT_NEAR(extent.width(), 0.02 / omega, 1e-8);
}

TEST(Plate, HitFromBothSidesKeepsMomentumAndEnergy) {
  auto simulation = test::simulate(
      squeezed("particle = [ { position = [0.1, 0.11], radius = 0.1, velocity = [0.0, -3.0] },"
               "{ position = [-0.05, -0.08], radius = 0.05, velocity = [0.0, 2.0] } ]",
               20.0, 0.0));
  const double heavy = 1000.0 * std::numbers::pi * 0.01, light = 0.25 * heavy;
  simulation.run(6000);

  const double v1 = test::particle(simulation, 1).velocity[1],
               v2 = test::particle(simulation, 2).velocity[1],
               v3 = simulation.walls()[0].velocity[1];
  EXPECT_EQ(simulation.measure().elastic.value(), 0.0);  // nobody touches anybody
  EXPECT_NEAR(heavy * v1 + light * v2 + 20.0 * v3, -3.0 * heavy + 2.0 * light, 1e-9);
  EXPECT_NEAR(heavy * v1 * v1 + light * v2 * v2 + 20.0 * v3 * v3, 9.0 * heavy + 4.0 * light, 0.01);
  EXPECT_NEAR(simulation.walls()[0].work, -0.5 * 20.0 * v3 * v3, 1e-9);
}

TEST(Plate, ReboundsFromAFixedDiskWithTheRestitutionOfTheDeck) {
  std::string deck =
      squeezed("particle = [ { position = [0.0, 0.101], radius = 0.1 } ]\nfixed = true", 20.0, 1.0);
  deck += "\n[[pair]]\nmaterials = [\"m\", \"m\"]\nnormal_stiffness = 1e6\nrestitution = 0.5\n";
  auto simulation = test::simulate(deck, {"contact.no_tension=false"});

  simulation.run(3000);

  EXPECT_NEAR(simulation.walls()[0].velocity[1], -0.5, 0.005);
}

TEST(Plate, IsAmongTheLimitsOfTheStepWithWhatItTouches) {
  const auto limit_of = [](double mass, const std::string& more) {
    const Deck read = parse_deck(piston_deck(mass, 0.0, more), "test.toml");
    for (const StepLimit& limit :
         step_limits(read.model, make_particles(read.model, read.sources))) {
      if (limit.what.starts_with("plate piston on 1 of m")) return limit.step;
    }
    return 0.0;
  };
  const double disk = 1000.0 * std::numbers::pi * 0.01;

  EXPECT_NEAR(limit_of(2.0, ""), 2.0 * std::sqrt(1.0 / (1.0 / 2.0 + 1.0 / disk) / 1e6), 1e-9);
  EXPECT_NEAR(limit_of(2.0, "fixed = true"), 2.0 * std::sqrt(2.0 / 1e6), 1e-9);
}

}  // namespace
}  // namespace barchan
