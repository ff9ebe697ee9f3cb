// Walls that meet have one surface: a particle at a joint feels it once.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

constexpr double kWeight = 1000.0 * std::numbers::pi * 0.05 * 0.05 * 9.81;

std::string plate(const std::string& name, const std::string& point, const std::string& normal,
                  const std::string& size) {
  return fmt::format(
      "[[wall]]\nname = \"{}\"\nkind = \"plate\"\npoint = {}\nnormal = {}\n{}\nmaterial = \"m\"\n",
      name, point, normal, size);
}

/// A disk of radius 0.05 m that rests at its weight's overlap, and walls.
std::string disk_on(const std::string& particle, const std::string& walls) {
  return fmt::format(R"(
dimension = 2
gravity = [0.0, -9.81]
[domain]
lo = [-1.0, -0.5]
hi = [1.0, 1.0]
[time]
step = 1e-5
steps = 1000000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
tangential_stiffness = 5e4
friction = 0.3
[[particles]]
kind = "list"
material = "m"
particle = [ {{ {}, radius = 0.05 }} ]
{})",
                     particle, walls);
}

std::string two_plates(const std::string& particle) {
  return disk_on(particle, plate("left", "[-0.5, 0.0]", "[0.0, 1.0]", "width = 1.0") +
                               plate("right", "[0.5, 0.0]", "[0.0, 1.0]", "width = 1.0"));
}

std::string one_plate(const std::string& particle) {
  return disk_on(particle, plate("floor", "[0.0, 0.0]", "[0.0, 1.0]", "width = 2.0"));
}

/// Of the particles on all walls, along an axis [N].
double force_on_walls(const Simulation& simulation, int axis) {
  double sum = 0.0;
  for (const WallState& wall : simulation.walls()) sum += wall.force[axis];
  return sum;
}

const std::string kAtRest = fmt::format("{:.17g}", 0.05 - kWeight / 1e5);

TEST(Joint, ADiskRollsOverCoplanarPlatesWithoutAHop) {
  auto simulation = test::simulate(two_plates(
      fmt::format("position = [-0.06, {}], velocity = [0.8, 0.0], omega = -16.0", kAtRest)));

  for (int k = 0; k < 150; ++k) {
    simulation.run(100);
    (void)simulation.measure();
    ASSERT_NEAR(force_on_walls(simulation, 1), -kWeight, 1e-6 * kWeight) << simulation.step();
  }
  EXPECT_NEAR(test::particle(simulation, 1).position[0], 0.06, 1e-6);
}

TEST(Joint, ASlidingDiskTakesItsSpringAlong) {
  const std::string sliding = fmt::format("position = [-0.06, {}], velocity = [0.8, 0.0]", kAtRest);
  auto joined = test::simulate(two_plates(sliding)), single = test::simulate(one_plate(sliding));

  joined.run(15000);
  single.run(15000);

  const auto a = test::particle(joined, 1), b = test::particle(single, 1);
  EXPECT_GT(a.position[0], 0.0);
  EXPECT_LT(a.velocity[0], 0.6) << "it slides";
  EXPECT_NEAR(a.position[0], b.position[0], 1e-10);
  EXPECT_NEAR(a.velocity[0], b.velocity[0], 1e-9);
  EXPECT_NEAR(a.omega[2], b.omega[2], 1e-8);
}

TEST(Joint, ACornerPushesOnce) {
  // A ledge ends at the origin, where a wall goes down; the disk is in front of both ends.
  const double inside = 1e-4, along = (0.05 - inside) / std::numbers::sqrt2;
  auto simulation =
      test::simulate(disk_on(fmt::format("position = [{:.17g}, {:.17g}]", along, along),
                             plate("ledge", "[-0.25, 0.0]", "[0.0, 1.0]", "width = 0.5") +
                                 plate("drop", "[0.0, -0.2]", "[1.0, 0.0]", "width = 0.4")));
  const Measures measures = simulation.measure();

  const double force = 1e5 * inside / std::numbers::sqrt2;
  EXPECT_NEAR(force_on_walls(simulation, 0), -force, 1e-6 * force);
  EXPECT_NEAR(force_on_walls(simulation, 1), -force, 1e-6 * force);
  EXPECT_NEAR(measures.elastic.value(), 0.5 * 1e5 * inside * inside, 1e-9);
}

TEST(Joint, ASphereFeelsOneOfFourPlatesWithACommonCorner) {
  std::string deck = R"(
dimension = 3
[domain]
lo = [-1.0, -1.0, -0.5]
hi = [1.0, 1.0, 1.0]
[time]
step = 1e-5
steps = 1000000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
[[particles]]
kind = "list"
material = "m"
particle = [ { position = [-0.02, -0.01, 0.0499], radius = 0.05, velocity = [2.0, 1.0, 0.0] } ]
)";
  for (const char* point :
       {"[-0.5, -0.5, 0.0]", "[0.5, -0.5, 0.0]", "[-0.5, 0.5, 0.0]", "[0.5, 0.5, 0.0]"})
    deck += plate(fmt::format("w{}", deck.size()), point, "[0.0, 0.0, 1.0]",
                  "width = 1.0\ndepth = 1.0");
  auto simulation = test::simulate(deck);
  for (int k = 0; k < 20; ++k) {  // the centre passes over the common corner
    (void)simulation.measure();
    const double overlap = 0.05 - test::particle(simulation, 1).position[2];
    ASSERT_NEAR(force_on_walls(simulation, 2), -1e5 * std::max(overlap, 0.0), 1e-6) << k;
    simulation.run(100);
  }
}

TEST(Joint, AnUprightPlateOnAFloorHasNoEndToRunInto) {
  // The centre is right over the end of a low plate that stands under the floor.
  auto simulation = test::simulate(
      disk_on(fmt::format("position = [-0.03, {}], velocity = [0.8, 0.0], omega = -16.0", kAtRest),
              "[[wall]]\nname = \"floor\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\nmaterial = "
              "\"m\"\n" +
                  plate("pile", "[0.0, -0.2]", "[1.0, 0.0]", "width = 0.4")));
  for (int k = 0; k < 75; ++k) {
    simulation.run(100);
    (void)simulation.measure();
    ASSERT_NEAR(force_on_walls(simulation, 1), -kWeight, 1e-6 * kWeight) << simulation.step();
  }
}

}  // namespace
}  // namespace barchan
