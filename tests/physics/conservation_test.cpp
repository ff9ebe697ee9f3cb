// What collisions keep: energy without damping and friction, momentum always.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

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

INSTANTIATE_TEST_SUITE_P(Dimensions, Gas, testing::Values(2, 3),
                         [](const auto& given) { return fmt::format("In{}D", given.param); });

}  // namespace
}  // namespace barchan
