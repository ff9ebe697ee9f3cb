// Walls: the work they do, the balance of forces at rest, and local damping on the way there.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

std::string wall(const std::string& name, const std::string& point, const std::string& normal,
                 const std::string& more = "") {
  return fmt::format("[[wall]]\nname = \"{}\"\npoint = {}\nnormal = {}\nmaterial = \"m\"\n{}\n",
                     name, point, normal, more);
}

TEST(Wall, DoesTheWorkThatAnElasticGasGains) {
  std::string deck = R"(
dimension = 2
[domain]
lo = [0.0, 0.0]
hi = [2.0, 1.0]
[time]
step = 5e-5
steps = 1000000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
[[particles]]
kind = "lattice"
region = { lo = [0.0, 0.0], hi = [2.0, 1.0] }
spacing = 0.2
radius = 0.05
jitter = 0.8
material = "m"
)";
  deck += wall("left", "[0.0, 0.0]", "[1.0, 0.0]") + wall("floor", "[0.0, 0.0]", "[0.0, 1.0]") +
          wall("ceiling", "[0.0, 1.0]", "[0.0, -1.0]") +
          wall("piston", "[2.0, 0.0]", "[-1.0, 0.0]", "velocity = [-0.5, 0.0]");
  const Deck read = parse_deck(deck, "piston.toml");
  ParticleSet set = make_particles(read.model, read.sources);
  for (ParticleData& p : set.particles) {
    const auto n = static_cast<double>(p.id);
    p.velocity = Vec3(std::sin(7.0 * n), std::cos(5.0 * n), 0.0);
  }
  RunOptions options;
  options.threads = 1;
  Simulation simulation(read.model, set, MPI_COMM_WORLD, options);
  const double start = test::total_energy(simulation);

  simulation.run(20000);  // 0.5 m inwards
  const double work = simulation.walls()[3].work;
  const double gained = test::total_energy(simulation) - start;

  EXPECT_NEAR(simulation.walls()[3].point[0], 1.5, 1e-3);
  EXPECT_GT(gained, 0.1 * start);
  (void)simulation.measure();
  EXPECT_NEAR(simulation.walls()[3].work, gained, 2e-3 * gained) << work;
}

TEST(Wall, DoesTheWorkThatADashpotTakesAndASpringKeeps) {
  // A disk is pressed between a moving wall and a still one; both contacts damp.
  std::string deck = R"(
dimension = 2
[domain]
lo = [0.0, 0.0]
hi = [1.0, 1.0]
[time]
step = 1e-5
steps = 1000000
[contact]
no_tension = false
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
normal_damping = 400.0
[[particles]]
kind = "list"
material = "m"
particle = [{ position = [0.1, 0.5], radius = 0.1 }]
)";
  deck += wall("still", "[0.0, 0.0]", "[1.0, 0.0]") +
          wall("moving", "[0.2, 0.0]", "[-1.0, 0.0]", "velocity = [-0.1, 0.0]");
  auto simulation = test::simulate(deck);
  double taken = 0.0;

  for (int k = 0; k < 10000; ++k) {  // 1 cm
    simulation.run(1);
    const OwnedParticle p = test::particle(simulation, 1);
    const double v = p.velocity[0];
    const bool touches_still = p.position[0] < 0.1;
    taken += 1e-5 * 400.0 * ((touches_still ? v * v : 0.0) + (v + 0.1) * (v + 0.1));
  }

  const Measures m = simulation.measure();
  const double kept = m.kinetic.value() + m.elastic.value();
  EXPECT_NEAR(m.elastic.value(), 2.0 * 0.5 * 1e5 * 0.005 * 0.005, 0.02);
  EXPECT_GT(taken, 0.02 * kept);
  EXPECT_NEAR(simulation.walls()[1].work, taken + kept, 3e-3 * kept);
}

TEST(LocalDamping, TakesItsShareOfEveryForce) {
  // Falling, a body feels (1 − alpha)·g; thrown up, (1 + alpha)·g.
  const std::string deck = R"(
dimension = 2
gravity = [0.0, -10.0]
[domain]
lo = [0.0, -10.0]
hi = [1.0, 10.0]
[time]
step = 1e-3
steps = 1000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
[[particles]]
kind = "list"
material = "m"
particle = [
  { position = [0.2, 0.0], radius = 0.1, velocity = [0.0, -1.0] },
  { position = [0.8, 0.0], radius = 0.1, velocity = [0.0, 5.0] },
]
[[stage]]
name = "one"
local_damping = 0.7
)";
  auto simulation = test::simulate(deck);

  simulation.run(200);

  const double t = 0.2 - 0.5e-3;  // velocities are half a step behind
  EXPECT_NEAR(test::particle(simulation, 1).velocity[1], -1.0 - 3.0 * t, 1e-9);
  EXPECT_NEAR(test::particle(simulation, 2).velocity[1], 5.0 - 17.0 * t, 1e-9);
}

constexpr const char* kBox = R"(
gravity = [0.0, -9.81]
[domain]
lo = [0.0, 0.0]
hi = [1.0, 3.0]
[time]
step = 1e-4
steps = 1000000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
tangential_stiffness = 5e4
normal_damping = 100.0
tangential_damping = 50.0
friction = 0.5
[[particles]]
kind = "packing"
region = { lo = [0.0, 0.0], hi = [1.0, 1.0] }
radius = [0.04, 0.06]
solid_fraction = 0.75
material = "m"
[[stage]]
name = "settle"
local_damping = 0.5
max_time = 1.0
[[stage]]
name = "load"
local_damping = 0.5
)";

TEST(AtRest, WallsBearTheWeightAndTheLoadOfThePlate) {
  std::string deck = std::string("dimension = 2\n") + kBox;
  deck += wall("floor", "[0.0, 0.0]", "[0.0, 1.0]") + wall("left", "[0.0, 0.0]", "[1.0, 0.0]") +
          wall("right", "[1.0, 0.0]", "[-1.0, 0.0]") +
          wall("plate", "[0.5, 1.1]", "[0.0, -1.0]",
               "kind = \"plate\"\nwidth = 0.9\nload = 3000.0\nmass = 100.0\ndamping = "
               "2000.0\nfrom_stage = \"load\"");
  auto simulation = test::simulate(deck);
  double weight = 0.0;
  simulation.for_each_owned([&](const OwnedParticle& p) { weight += p.mass * 9.81; });

  simulation.run(9900);
  (void)simulation.measure();
  const double before = -simulation.walls()[0].force[1] - simulation.walls()[1].force[1] -
                        simulation.walls()[2].force[1];
  simulation.run(50000);
  const Measures m = simulation.measure();

  const auto walls = simulation.walls();
  const double load = 3000.0 * 0.9;
  const double borne = -walls[0].force[1] - walls[1].force[1] - walls[2].force[1];
  const double sides =
      walls[1].force[0] + walls[2].force[0] + walls[0].force[0] + walls[3].force[0];
  EXPECT_NEAR(before, weight, 0.01 * weight);  // settled, though not yet at rest
  EXPECT_LT(m.kinetic.value(), 1e-8 * m.elastic.value());
  EXPECT_NEAR(walls[3].force[1], load, 1e-3 * load);
  EXPECT_NEAR(borne, weight + load, 1e-3 * (weight + load));
  EXPECT_NEAR(sides, 0.0, 1e-3 * (weight + load));
  EXPECT_GT(std::fabs(walls[1].force[1]) + std::fabs(walls[2].force[1]),
            0.01 * weight);  // walls rub
}

TEST(AtRest, APileOfSpheresStandsOnItsFloorWithItsWeight) {
  const std::string deck = R"(
dimension = 3
gravity = [0.0, 0.0, -9.81]
[domain]
lo = [0.0, 0.0, 0.0]
hi = [0.5, 0.5, 1.0]
periodic = ["x", "y"]
[time]
step = 1e-4
steps = 1000000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 2e4
tangential_stiffness = 1e4
normal_damping_rate = 100.0
tangential_damping_rate = 50.0
friction = 0.4
[[particles]]
kind = "packing"
region = { lo = [0.0, 0.0, 0.0], hi = [0.5, 0.5, 0.5] }
radius = [0.04, 0.06]
solid_fraction = 0.5
material = "m"
[[stage]]
name = "one"
local_damping = 0.5
)" + wall("floor", "[0.0, 0.0, 0.0]", "[0.0, 0.0, 1.0]");
  auto simulation = test::simulate(deck);
  double weight = 0.0;
  simulation.for_each_owned([&](const OwnedParticle& p) { weight += p.mass * 9.81; });

  simulation.run(30000);
  (void)simulation.measure();

  EXPECT_NEAR(-simulation.walls()[0].force[2], weight, 1e-3 * weight);
  EXPECT_NEAR(simulation.walls()[0].force[0], 0.0, 1e-3 * weight);
}

}  // namespace
}  // namespace barchan
