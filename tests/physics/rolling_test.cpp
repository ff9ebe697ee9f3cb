// A disk and a sphere set sliding on a floor: friction turns them until they roll. Their slip falls
// evenly; only the last of it goes softly, as the tangential spring and dashpot take over.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

struct Rolling {
  double share;  ///< of the first speed, once it rolls
  double time;   ///< until the slip is down to 5 % [s]
  double slip;   ///< speed of the surface against the floor at the end [m/s]
};

constexpr double kGravity = 9.81, kFriction = 0.3, kSpeed = 1.0, kRadius = 0.1, kStiffness = 1e6;

Rolling slide(int dimension) {
  const double volume =
      std::numbers::pi * kRadius * kRadius * (dimension == 2 ? 1.0 : 4.0 / 3.0 * kRadius);
  const double sunk = volume * 1000.0 * kGravity / kStiffness;
  const bool is_flat = dimension == 2;
  auto simulation = test::simulate(fmt::format(
      R"(
dimension = {0}
gravity = {1}
[domain]
lo = {2}
hi = {3}
[time]
step = 1e-5
steps = 100000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e6
tangential_stiffness = 1e6
normal_damping_rate = 100.0
tangential_damping_rate = 20.0
friction = 0.3
[[particles]]
kind = "list"
material = "m"
particle = [{{ position = {4}, velocity = {5}, radius = 0.1 }}]
[[wall]]
name = "floor"
point = {2}
normal = {6}
material = "m"
)",
      dimension, is_flat ? "[0.0, -9.81]" : "[0.0, 0.0, -9.81]",
      is_flat ? "[0.0, 0.0]" : "[0.0, 0.0, 0.0]", is_flat ? "[2.0, 1.0]" : "[2.0, 1.0, 1.0]",
      is_flat ? fmt::format("[0.2, {}]", kRadius - sunk)
              : fmt::format("[0.2, 0.5, {}]", kRadius - sunk),
      is_flat ? "[1.0, 0.0]" : "[1.0, 0.0, 0.0]", is_flat ? "[0.0, 1.0]" : "[0.0, 0.0, 1.0]"));
  const auto slip = [&](const OwnedParticle& p) {
    return p.velocity[0] + kRadius * (is_flat ? p.omega[2] : -p.omega[1]);
  };
  Rolling result{};
  while (simulation.step() < 30000) {
    simulation.run(10);
    const double s = slip(test::particle(simulation, 1));
    if (result.time == 0.0 && s < 0.05 * kSpeed) result.time = simulation.time();
  }
  result.share = test::particle(simulation, 1).velocity[0] / kSpeed;
  result.slip = slip(test::particle(simulation, 1));
  return result;
}

TEST(SlidingToRolling, LeavesADiskTwoThirdsOfItsSpeed) {
  const Rolling got = slide(2);

  EXPECT_NEAR(got.share, 2.0 / 3.0, 1e-3);
  EXPECT_NEAR(got.time, 0.95 * kSpeed / (3.0 * kFriction * kGravity), 3e-3 * got.time);
  EXPECT_NEAR(got.slip, 0.0, 1e-3);
}

TEST(SlidingToRolling, LeavesASphereFiveSevenths) {
  const Rolling got = slide(3);

  EXPECT_NEAR(got.share, 5.0 / 7.0, 1e-3);
  EXPECT_NEAR(got.time, 0.95 * 2.0 * kSpeed / (7.0 * kFriction * kGravity), 3e-3 * got.time);
  EXPECT_NEAR(got.slip, 0.0, 1e-3);
}

}  // namespace
}  // namespace barchan
