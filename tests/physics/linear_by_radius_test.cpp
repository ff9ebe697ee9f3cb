// Linear contacts whose springs follow from a modulus and the radii, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

constexpr double kPi = std::numbers::pi, kModulus = 1e6, kDensity = 1000.0;

double mass_of(int dimension, double radius) {
  return kDensity * kPi * radius * radius * (dimension == 2 ? 1.0 : 4.0 / 3.0 * radius);
}

std::string deck(int dimension, double dt, const std::string& more, const std::string& particles) {
  const std::string third = dimension == 2 ? "" : ", 0.0";
  return fmt::format(R"(
dimension = {0}
[domain]
lo = [-1.0, 0.0{1}]
hi = [1.0, 1.0{2}]
[time]
step = {3}
steps = 1000000
[contact]
stiffness = "radius"
[[material]]
name = "m"
density = {4}
young_modulus = {5}
{6}
[[wall]]
name = "floor"
point = [0.0, 0.0{1}]
normal = [0.0, 1.0{1}]
material = "m"
[[particles]]
kind = "list"
material = "m"
particle = [{7}]
)",
                     dimension, third, dimension == 2 ? "" : ", 1.0", dt, kDensity, kModulus, more,
                     particles);
}

std::string ball(int dimension, double x, double y, double radius, double speed) {
  return fmt::format("{{ position = [{}, {}{}], radius = {}, velocity = [{}, 0.0{}] }},", x, y,
                     dimension == 2 ? "" : ", 0.5", radius, speed, dimension == 2 ? "" : ", 0.0");
}

class ByRadius : public testing::TestWithParam<int> {};

TEST_P(ByRadius, AParticleSinksIntoAFloorByItsWeightOverTwiceEr) {
  const int dim = GetParam();
  const double r = 0.1, weight = mass_of(dim, r) * 9.81, overlap = weight / (2.0 * kModulus * r);
  auto simulation =
      test::simulate(deck(dim, 1e-5, "restitution = 0.3", ball(dim, 0.0, r - overlap, r, 0.0)),
                     {dim == 2 ? "gravity=[0.0, -9.81]" : "gravity=[0.0, -9.81, 0.0]"});

  simulation.run(5000);

  EXPECT_NEAR(test::particle(simulation, 1).position[1], r - overlap, 1e-9 * r);
  EXPECT_NEAR(simulation.measure().elastic.value(), 0.5 * weight * overlap,
              1e-6 * weight * overlap);
}

TEST_P(ByRadius, CollisionsTakeAsLongAndReboundAsTheirRadiiSay) {
  const int dim = GetParam();
  for (const auto& [a, b] : {std::pair(0.1, 0.1), std::pair(0.1, 0.03)}) {
    const double reduced = a * b / (a + b), kn = 2.0 * kModulus * reduced;
    const double m = mass_of(dim, a) * mass_of(dim, b) / (mass_of(dim, a) + mass_of(dim, b));
    const double time = kPi * std::sqrt(m / kn), dt = time / 4000.0;
    auto simulation = test::simulate(deck(dim, dt, "restitution = 1.0",
                                          ball(dim, -a, 0.5, a, 0.1) + ball(dim, b, 0.5, b, -0.1)));
    simulation.run(1);
    int steps = 1;
    while (simulation.measure().contacts > 0) simulation.run(1), ++steps;
    EXPECT_NEAR(steps / 4000.0, 1.0, 2e-3) << a << " on " << b;

    auto damped = test::simulate(deck(dim, dt, "restitution = 0.6",
                                      ball(dim, -a, 0.5, a, 0.1) + ball(dim, b, 0.5, b, -0.1)));
    damped.run(8000);
    const double parting =
        test::particle(damped, 2).velocity[0] - test::particle(damped, 1).velocity[0];
    EXPECT_NEAR(parting / 0.2, 0.6, 1e-3) << a << " on " << b;
  }
}

TEST_P(ByRadius, ATangentialSpringIsItsRatioOfTheNormalOne) {
  const int dim = GetParam();
  const double r = 0.1, weight = mass_of(dim, r) * 9.81, overlap = weight / (2.0 * kModulus * r);
  auto simulation =
      test::simulate(deck(dim, 1e-5,
                          "restitution = 0.3\nfriction = 10.0\ntangential_stiffness_ratio = 0.5\n"
                          "tangential_damping_ratio = 0.0",
                          ball(dim, 0.0, r - overlap, r, 0.0)),
                     {dim == 2 ? "gravity=[0.0, -9.81]" : "gravity=[0.0, -9.81, 0.0]"});
  const double gain = dim == 2 ? 2.0 : 2.5, kt = 0.5 * 2.0 * kModulus * r;
  const double period = 2.0 * kPi * std::sqrt(mass_of(dim, r) / (kt * (1.0 + gain)));
  const std::vector<std::int64_t> first{1};
  simulation.scatter(ParticleField::Velocity, first, std::vector<double>{1e-4, 0.0, 0.0});
  // The surface swings; where it turns back, centre and spin go on as one that rolls.
  const auto slip = [&] {
    const OwnedParticle p = test::particle(simulation, 1);
    return p.velocity[0] + p.omega[2] * r;
  };

  while (slip() > 0.0) simulation.run(1);

  EXPECT_NEAR(simulation.time() / (0.25 * period), 1.0, 5e-3);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, ByRadius, testing::Values(2, 3));

}  // namespace
}  // namespace barchan
