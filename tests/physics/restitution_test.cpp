// Whatever meets whatever, a deck's restitution is what rebounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSteps = 1000;  // of an undamped contact of the lightest pair

double mass_of(int dimension, double radius) {
  return 1000.0 * kPi * radius * radius * (dimension == 2 ? 1.0 : 4.0 / 3.0 * radius);
}

/// Head-on collisions that all begin at once, far from each other: two equal particles, two unequal
/// ones, one and a fixed one, one and a wall.
std::string collisions(int dimension, double dt, const std::string& contact,
                       const std::string& material) {
  const auto at = [&](double x, double y) {
    return dimension == 2 ? fmt::format("[{}, {}]", x, y) : fmt::format("[{}, {}, 0.0]", x, y);
  };
  const auto grain = [&](double x, double y, double v, double radius) {
    return fmt::format("{{ position = {}, velocity = {}, radius = {} }},\n", at(x, y), at(v, 0.0),
                       radius);
  };
  const std::string all = grain(-0.1, 0.0, 0.5, 0.1) + grain(0.1, 0.0, -0.5, 0.1) +
                          grain(-0.1, 1.0, 0.5, 0.1) + grain(0.05, 1.0, -0.5, 0.05) +
                          grain(-0.1, 2.0, 1.0, 0.1) + grain(-1.9, 3.0, -1.0, 0.1);
  const std::string lo = dimension == 2 ? "[-2.0, -1.0]" : "[-2.0, -1.0, -1.0]";
  const std::string hi = dimension == 2 ? "[2.0, 4.0]" : "[2.0, 4.0, 1.0]";
  return fmt::format(R"(
dimension = {}
[domain]
lo = {}
hi = {}
[time]
step = {:.17g}
steps = 1000000
[contact]
{}
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
{}
[[particles]]
kind = "list"
material = "m"
particle = [
{}]
[[particles]]
kind = "list"
material = "m"
fixed = true
particle = [{{ position = {}, radius = 0.1 }}]
[[wall]]
name = "left"
point = {}
normal = {}
material = "m"
)",
                     dimension, lo, hi, dt, contact, material, all, at(0.1, 2.0), at(-2.0, 0.0),
                     at(1.0, 0.0));
}

/// Speeds after over speeds before, in the order above.
std::vector<double> rebounds(int dimension, const std::string& contact,
                             const std::string& material) {
  const double heavy = mass_of(dimension, 0.1), light = mass_of(dimension, 0.05);
  const double shortest = kPi * std::sqrt(heavy * light / (heavy + light) / 1e5);
  const double longest = 2.2 * kPi * std::sqrt(heavy / 1e5);
  auto simulation = test::simulate(collisions(dimension, shortest / kSteps, contact, material));
  simulation.run(static_cast<std::int64_t>(longest / shortest * kSteps));
  const auto v = [&](std::int64_t id) { return test::particle(simulation, id).velocity[0]; };
  return {v(2) - v(1), v(4) - v(3), -v(5), v(6)};
}

class Rebound : public testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(Rebound, IsTheRestitutionOfTheDeck) {
  const auto& [dimension, no_tension] = GetParam();
  for (const double e : {1.0, 0.9, 0.7, 0.5, 0.3, 0.14, 0.13, 0.1, 0.03, 0.01}) {
    const auto got = rebounds(dimension, fmt::format("no_tension = {}", no_tension),
                              fmt::format("restitution = {}", e));

    for (const double rebound : got) EXPECT_NEAR(rebound, e, 0.002) << e;
  }
}

INSTANTIATE_TEST_SUITE_P(Contact, Rebound, testing::Combine(testing::Values(2, 3), testing::Bool()),
                         [](const auto& given) {
                           return fmt::format("{}In{}D",
                                              std::get<1>(given.param) ? "Clamped" : "Free",
                                              std::get<0>(given.param));
                         });

struct Mix {
  const char *first, *second;
  double restitution;
};

/// Two materials of unequal stiffness meet.
double mixed_rebound(const Mix& mix, bool no_tension) {
  const double kn = 2.0 / (1.0 / 4e5 + 1.0 / 1e5);
  const double contact = kPi * std::sqrt(0.5 * mass_of(3, 0.1) / kn);
  auto simulation =
      test::simulate(fmt::format(R"(
dimension = 3
[domain]
lo = [-1.0, -1.0, -1.0]
hi = [1.0, 1.0, 1.0]
[time]
step = {:.17g}
steps = 1000000
[contact]
no_tension = {}
[[material]]
name = "hard"
density = 1000.0
normal_stiffness = 4e5
{}
[[material]]
name = "soft"
density = 1000.0
normal_stiffness = 1e5
{}
[[particles]]
kind = "list"
material = "hard"
particle = [{{ position = [-0.1, 0.0, 0.0], velocity = [0.5, 0.0, 0.0], radius = 0.1 }}]
[[particles]]
kind = "list"
material = "soft"
particle = [{{ position = [0.1, 0.0, 0.0], velocity = [-0.5, 0.0, 0.0], radius = 0.1 }}]
)",
                                 contact / kSteps, no_tension, mix.first, mix.second));
  simulation.run(3 * kSteps);
  return test::particle(simulation, 2).velocity[0] - test::particle(simulation, 1).velocity[0];
}

TEST(MixedRestitution, IsTheGeometricMean) {
  for (const Mix& mix : {Mix{"restitution = 0.9", "restitution = 0.1", 0.3},
                         Mix{"restitution = 0.1", "restitution = 1.0", std::sqrt(0.1)},
                         Mix{"restitution = 0.04", "restitution = 0.01", 0.02},
                         Mix{"restitution = 1.0", "restitution = 1.0", 1.0}}) {
    for (const bool no_tension : {true, false})
      EXPECT_NEAR(mixed_rebound(mix, no_tension), mix.restitution, 0.002) << mix.first;
  }
}

TEST(MixedRestitution, IsOneWhereOneSideDampsInNoWay) {
  EXPECT_NEAR(mixed_rebound({"restitution = 0.5", "", 1.0}, true), 1.0, 1e-3);
}

/// A ball falls on a floor with the speed of 1 m. How fast it gets upwards over how fast it came:
/// what remains of the overlap when the force ends is climbed without help, against its weight.
double bounce(double restitution) {
  const double speed = std::sqrt(2.0 * 9.81);
  auto simulation = test::simulate(fmt::format(R"(
dimension = 3
gravity = [0.0, 0.0, -9.81]
[domain]
lo = [-1.0, -1.0, -0.5]
hi = [1.0, 1.0, 3.0]
[time]
step = 2e-6
steps = 1000000
[[material]]
name = "rubber"
density = 2500.0
normal_stiffness = 1e6
restitution = {}
[[particles]]
kind = "list"
material = "rubber"
particle = [{{ position = [0.0, 0.0, 0.05], velocity = [0.0, 0.0, {}], radius = 0.05 }}]
[[wall]]
name = "floor"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
material = "rubber"
)",
                                               restitution, -speed));
  double fastest = 0.0;
  while (simulation.step() < 4000) {
    simulation.run(10);
    fastest = std::max(fastest, test::particle(simulation, 1).velocity[2]);
  }
  return fastest / speed;
}

TEST(Rebound, OfABallThatFallsIsTheRestitution) {
  for (const double e : {0.9, 0.7, 0.5, 0.3, 0.1}) EXPECT_NEAR(bounce(e), e, 0.002);
}

}  // namespace
}  // namespace barchan
