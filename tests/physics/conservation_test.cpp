// What collisions keep: energy without damping and friction, momentum always.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <barchan/core/model/mass.hpp>

#include "physics_case.hpp"

namespace barchan {
namespace {

/// A dense gas in a periodic box: sites of a lattice, jittered, every particle with its own
/// velocity.
Simulation make_gas(int dimension, const std::string& material, double dt) {
  const Deck deck = parse_deck(
      fmt::format(R"(
dimension = {0}
[domain]
lo = [0.0, 0.0{1}]
hi = [1.2, 1.2{2}]
periodic = ["x", "y"{3}]
[time]
step = {4}
steps = 1000000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
{5}
[[particles]]
kind = "lattice"
region = {{ lo = [0.0, 0.0{1}], hi = [1.2, 1.2{2}] }}
spacing = {6}
radius = [0.03, 0.04]
jitter = 0.9
material = "m"
)",
                  dimension, dimension == 2 ? "" : ", 0.0", dimension == 2 ? "" : ", 1.2",
                  dimension == 2 ? "" : ", \"z\"", dt, material, dimension == 2 ? 0.1 : 0.15),
      "gas.toml");
  ParticleSet set = make_particles(deck.model, deck.sources);
  for (ParticleData& p : set.particles) {
    const auto n = static_cast<double>(p.id);
    p.velocity =
        Vec3(std::sin(7.0 * n), std::cos(5.0 * n), dimension == 2 ? 0.0 : std::sin(3.0 * n));
    p.omega = Vec3(0.0, 0.0, 10.0 * std::sin(n));
  }
  RunOptions options;
  options.threads = 1;
  return {deck.model, set, MPI_COMM_WORLD, options};
}

class Gas : public testing::TestWithParam<int> {};

TEST_P(Gas, KeepsItsEnergyOverTenThousandStepsWithoutDampingAndFriction) {
  auto simulation = make_gas(GetParam(), "", 1e-4);
  const double start = test::total_energy(simulation);

  double worst = 0.0, contacts = 0.0;
  for (int k = 0; k < 100; ++k) {
    simulation.run(99);
    worst = std::max(worst, std::fabs(test::total_energy(simulation) / start - 1.0));
    contacts += static_cast<double>(simulation.measure().contacts);
  }

  RecordProperty("largest_energy_error", std::to_string(worst));
  EXPECT_EQ(simulation.step(), 10001);
  EXPECT_GT(contacts, 500.0);  // they do collide
  EXPECT_LT(worst, 3e-4) << "of " << start << " J";
}

TEST_P(Gas, KeepsItsMomentumToRoundingWithDampingAndFriction) {
  auto simulation = make_gas(
      GetParam(),
      "restitution = 0.9\ntangential_stiffness = 5e4\ntangential_damping = 20.0\nfriction = 0.4",
      1e-4);
  const Measures start = simulation.measure();
  double sum = 0.0;  // of the sizes
  simulation.for_each_owned([&](const OwnedParticle& p) { sum += p.mass * p.velocity.norm(); });

  simulation.run(5000);

  const Measures end = simulation.measure();
  EXPECT_LT(end.kinetic.value(), 0.95 * start.kinetic.value());  // friction and damping work
  for (int c = 0; c < GetParam(); ++c) {
    const double drift = std::fabs(end.momentum[c].value() - start.momentum[c].value());
    EXPECT_LT(drift, 20.0 * std::numeric_limits<double>::epsilon() * sum) << "component " << c;
  }
}

/// A particle of radius 0.05 m that rests on a fixed one or on a wall, but moves along it.
Simulation make_sticking(int dimension, bool is_on_wall) {
  const double density = dimension == 2 ? 1000.0 : 15000.0;  // about the same mass
  Model model =
      parse_deck(fmt::format(R"(
dimension = {0}
gravity = [0.0, -9.81{1}]
[domain]
lo = [-1.0, -1.0{2}]
hi = [1.0, 1.0{3}]
[time]
step = 1e-5
steps = 1000000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
tangential_stiffness = 5e4
friction = 0.9
[[wall]]
name = "floor"
kind = "plane"
point = [0.0, -0.5{1}]
normal = [0.0, 1.0{1}]
material = "m"
[[particles]]
kind = "list"
material = "m"
particle = [{{ position = [0.0, 0.0{1}], radius = 0.05 }}]
)",
                             dimension, dimension == 2 ? "" : ", 0.0",
                             dimension == 2 ? "" : ", -1.0", dimension == 2 ? "" : ", 1.0"),
                 "sticking.toml")
          .model;
  ParticleData p{1, 0, 0.05, density, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), false};
  ParticleData q = p;
  q.id = 2, q.fixed = true;
  p.position[1] = (is_on_wall ? -0.45 : 0.1) - mass_of(p, dimension) * 9.81 / 1e5;
  p.velocity = Vec3(0.01, 0.0, dimension == 2 ? 0.0 : 0.007);
  RunOptions options;
  options.threads = 1;
  return {model, {{p, q}, {}}, MPI_COMM_WORLD, options};
}

TEST_P(Gas, KeepsItsEnergyInTangentialSprings) {
  for (const bool is_on_wall : {false, true}) {
    auto simulation = make_sticking(GetParam(), is_on_wall);
    const double kinetic = simulation.measure().kinetic.value(),
                 elastic = simulation.measure().elastic.value();
    simulation.run(1);
    const double start = test::total_energy(simulation);

    double stored = 0.0;
    for (int k = 0; k < 30; ++k) {
      simulation.run(99);
      EXPECT_NEAR(test::total_energy(simulation), start, 0.02 * kinetic) << k;
      stored = std::max(stored, simulation.measure().elastic.value() - elastic);
    }

    EXPECT_GT(stored, 0.25 * kinetic) << (is_on_wall ? "wall" : "pair");
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Gas, testing::Values(2, 3),
                         [](const auto& given) { return fmt::format("In{}D", given.param); });

}  // namespace
}  // namespace barchan
