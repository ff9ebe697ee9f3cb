// Walls in a periodic box: images act across the faces, also while walls and particles go through.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>

#include "physics_case.hpp"

namespace barchan {
namespace {

std::string box_with(const std::string& particle, const std::string& wall,
                     const std::string& more = "") {
  return fmt::format(R"(
dimension = 2
{}
[domain]
lo = [0.0, 0.0]
hi = [1.0, 1.0]
periodic = ["x"]
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
particle = [ {{ {} }} ]
[[wall]]
name = "w"
material = "m"
{}
)",
                     more, particle, wall);
}

constexpr const char* kFence =
    "kind = \"plate\"\npoint = [0.02, 0.5]\nnormal = [-1.0, 0.0]\nwidth = 0.6\n";

TEST(PeriodicWall, APlateBehindTheBorderThrowsBackWhatComesThroughIt) {
  auto simulation = test::simulate(
      box_with("position = [0.85, 0.5], radius = 0.05, velocity = [2.0, 0.0]", kFence));
  const double start = simulation.measure().kinetic.value();

  simulation.run(15000);
  const double end = simulation.measure().kinetic.value();

  EXPECT_NEAR(start, 0.5 * 1000.0 * std::numbers::pi * 0.0025 * 4.0, 1e-9);
  EXPECT_NEAR(end, start, 1e-3 * start);
  EXPECT_NEAR(test::particle(simulation, 1).velocity[0], -2.0, 1e-3);
}

TEST(PeriodicWall, APlateThatMovesThroughTheBorderIsStillThere) {
  // It catches up with a disk at rest, round after round.
  auto simulation = test::simulate(box_with("position = [0.3, 0.5], radius = 0.05",
                                            "kind = \"plate\"\npoint = [0.8, 0.5]\nnormal = [1.0, "
                                            "0.0]\nwidth = 0.6\nvelocity = [4.0, 0.0]\n"));

  simulation.run(20000);  // 0.8 m: through the border, and on
  EXPECT_NEAR(test::particle(simulation, 1).velocity[0], 8.0, 0.01);
  simulation.run(30000);  // the disk comes around and meets the plate from behind

  EXPECT_NEAR(test::particle(simulation, 1).velocity[0], 0.0, 0.02);
  EXPECT_NEAR(simulation.walls()[0].point[0], 2.8, 1e-6);
}

TEST(PeriodicWall, ALoadedPlateGoesThroughTheBorderWithWhatItPushes) {
  auto simulation = test::simulate(
      box_with("position = [0.70, 0.5], radius = 0.05",
               "kind = \"plate\"\npoint = [0.651, 0.5]\nnormal = [1.0, 0.0]\nwidth = 0.6\n"
               "load = 100.0\nmass = 20.0\n"));
  const double force = 60.0, mass = 20.0 + 1000.0 * std::numbers::pi * 0.0025;

  const double t = 0.8;
  simulation.run(std::lround(t / 1e-5));

  const double way = 0.5 * force / mass * t * t;
  EXPECT_GT(way, 0.6);
  EXPECT_NEAR(simulation.walls()[0].point[0], 0.651 + way, 2e-3);
  EXPECT_NEAR(test::particle(simulation, 1).position[0], 0.70 + way - 1.0, 2e-3);
}

/// A disk slides without friction on a plate, at its height of rest.
void expect_even_slide(const std::string& plate) {
  const double mass = 1000.0 * std::numbers::pi * 0.0025;
  const double height = 0.5 + 0.05 - mass * 10.0 / 1e5;
  auto simulation = test::simulate(box_with(
      fmt::format("position = [0.7, {:.17g}], radius = 0.05, velocity = [3.0, 0.0]", height), plate,
      "gravity = [0.0, -10.0]"));
  for (int k = 0; k < 60; ++k) {
    simulation.run(1000);  // 3 cm
    const OwnedParticle p = test::particle(simulation, 1);
    ASSERT_NEAR(p.position[1], height, 1e-9) << k;
    ASSERT_NEAR(p.velocity[0], 3.0, 1e-9) << k;
  }
}

TEST(PeriodicWall, APlateAsWideAsTheBoxHasNoSeam) {
  expect_even_slide("kind = \"plate\"\npoint = [0.2, 0.5]\nnormal = [0.0, 1.0]\nwidth = 1.0\n");
  expect_even_slide(
      "kind = \"plate\"\npoint = [0.2, 0.5]\nnormal = [0.0, 1.0]\nwidth = 1.0\nvelocity = [7.0, "
      "0.0]\n");
  expect_even_slide("point = [0.2, 0.5]\nnormal = [0.0, 1.0]\n");
}

TEST(PeriodicWall, APlateThatReachesThroughTheBorderCarriesOnBothSides) {
  // 0.6 … 1.3: a disk slides from one end to the other, and falls off where it ends.
  const double height = 0.5 + 0.05 - 1000.0 * std::numbers::pi * 0.0025 * 10.0 / 1e5;
  auto simulation = test::simulate(box_with(
      fmt::format("position = [0.7, {:.17g}], radius = 0.05, velocity = [3.0, 0.0]", height),
      "kind = \"plate\"\npoint = [0.95, 0.5]\nnormal = [0.0, 1.0]\nwidth = 0.7\n",
      "gravity = [0.0, -10.0]"));

  simulation.run(19000);  // at 1.27
  EXPECT_NEAR(test::particle(simulation, 1).position[1], height, 1e-9);
  simulation.run(3000);

  EXPECT_LT(test::particle(simulation, 1).position[1], height - 1e-3);
}

std::string refusal(const std::string& deck) {
  try {
    (void)parse_deck(deck, "box.toml");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(PeriodicWall, APlaneAcrossAPeriodicAxisIsRefused) {
  const std::string what = refusal(box_with("position = [0.5, 0.5], radius = 0.05",
                                            "point = [0.0, 0.0]\nnormal = [1.0, 0.0]\n"));
  EXPECT_TRUE(what.starts_with("box.toml:23:")) << what;
  EXPECT_NE(what.find("plane 'w' lies across the periodic axis x"), std::string::npos) << what;
  EXPECT_NE(refusal(box_with("position = [0.5, 0.5], radius = 0.05",
                             "point = [0.0, 0.0]\nnormal = [0.01, 1.0]\n"))
                .find("periodic axis x"),
            std::string::npos);
  EXPECT_EQ(refusal(box_with("position = [0.5, 0.5], radius = 0.05",
                             "point = [0.0, 0.0]\nnormal = [6.1e-17, 1.0]\n")),
            "");  // a cosine of a right angle

  Deck deck = parse_deck(
      box_with("position = [0.5, 0.5], radius = 0.05", "point = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"),
      "box.toml");
  deck.model.walls[0].normal = Vec3(1.0, 0.0, 0.0);  // a caller's
  const ParticleSet set = make_particles(deck.model, deck.sources);
  EXPECT_THROW(Simulation(deck.model, set, MPI_COMM_WORLD, RunOptions()), InputError);
}

}  // namespace
}  // namespace barchan
