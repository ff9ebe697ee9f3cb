// Two particles meet head-on: restitution, contact time and the constants that a pair gets.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kStiffness = 1e5;  // [N/m]
constexpr double kRadius = 0.1;     // [m]
constexpr double kDensity = 1000.0;
constexpr double kSpeed = 0.5;  // of each of the two [m/s]

struct Collision {
  double restitution, contact_time;
};

double mass_of(int dimension) {
  return kDensity * kPi * kRadius * kRadius * (dimension == 2 ? 1.0 : 4.0 / 3.0 * kRadius);
}

/// @param damping  a line of [[material]] @param num_steps  per contact time of the undamped pair
Collision collide(int dimension, const std::string& damping, bool no_tension, int num_steps) {
  const std::string z = dimension == 2 ? "" : ", 0.0";
  const double omega = std::sqrt(2.0 * kStiffness / mass_of(dimension));
  const double dt = kPi / omega / num_steps;
  auto simulation = test::simulate(fmt::format(R"(
dimension = {0}
[domain]
lo = [-1.0, -1.0{1}]
hi = [1.0, 1.0{2}]
[time]
step = {3}
steps = 1000000
[contact]
no_tension = {4}
[[material]]
name = "m"
density = {5}
normal_stiffness = {6}
{7}
[[particles]]
kind = "list"
material = "m"
particle = [
  {{ position = [-0.1, 0.0{8}], velocity = [0.5, 0.0{8}], radius = 0.1 }},
  {{ position = [0.1, 0.0{8}], velocity = [-0.5, 0.0{8}], radius = 0.1 }},
])",
                                               dimension, dimension == 2 ? "" : ", -1.0",
                                               dimension == 2 ? "" : ", 1.0", dt, no_tension,
                                               kDensity, kStiffness, damping, z));
  const auto gap = [&] {
    return test::particle(simulation, 2).position[0] - test::particle(simulation, 1).position[0] -
           2.0 * kRadius;
  };
  // Where the gap crosses zero, between steps by its rate.
  double before = gap(), from = 0.0, to = 0.0;
  while (to == 0.0 && simulation.step() < 100 * num_steps) {
    simulation.run(1);
    const double after = gap();
    if ((before > 0.0) != (after > 0.0)) {
      (after > 0.0 ? to : from) = simulation.time() - dt * after / (after - before);
    }
    before = after;
  }
  simulation.run(10);
  const double parting =
      test::particle(simulation, 2).velocity[0] - test::particle(simulation, 1).velocity[0];
  return {parting / (2.0 * kSpeed), to - from};
}

struct Oscillator {
  double zeta, decay, omega;  ///< damping ratio, 1/s, rad/s

  Oscillator(int dimension, double ratio) : zeta(ratio) {
    const double natural = std::sqrt(2.0 * kStiffness / mass_of(dimension));
    decay = zeta * natural;
    omega = natural * std::sqrt(1.0 - zeta * zeta);
  }
  [[nodiscard]] double restitution() const { return std::exp(-kPi * decay / omega); }
};

std::string damping_line(const std::string& kind, int dimension, double zeta) {
  const double reduced = 0.5 * mass_of(dimension);
  const double cn = 2.0 * zeta * std::sqrt(kStiffness * reduced);
  if (kind == "cn") return fmt::format("normal_damping = {}", cn);
  if (kind == "rate") return fmt::format("normal_damping_rate = {}", cn / reduced);
  return fmt::format("restitution = {}", Oscillator(dimension, zeta).restitution());
}

class HeadOn : public testing::TestWithParam<std::tuple<int, std::string>> {};

TEST_P(HeadOn, GivesRestitutionAndContactTimeOfTheDampedSpring) {
  const auto& [dimension, kind] = GetParam();
  for (const double zeta : {0.02, 0.2, 0.6}) {
    const Oscillator exact(dimension, zeta);
    const std::string line = damping_line(kind, dimension, zeta);

    const Collision got = collide(dimension, line, false, 2000);

    EXPECT_NEAR(got.restitution, exact.restitution(), 2e-3 * exact.restitution()) << zeta;
    EXPECT_NEAR(got.contact_time, kPi / exact.omega, 1e-3 * kPi / exact.omega) << zeta;
  }
}

class HeadOnClamped : public HeadOn {};

TEST_P(HeadOnClamped, PartsEarlierAndFasterWithoutTension) {
  // Schwager & Pöschel 2007, doi:10.1007/s10035-007-0065-z: the contact ends where the force does.
  const auto& [dimension, kind] = GetParam();
  for (const double zeta : {0.2, 0.6, 0.9}) {
    const Oscillator o(dimension, zeta);
    const double end =
        std::atan2(2.0 * o.decay * o.omega, o.decay * o.decay - o.omega * o.omega) / o.omega;
    const double exact = std::exp(-o.decay * end);

    const Collision got = collide(dimension, damping_line(kind, dimension, zeta), true, 2000);

    EXPECT_NEAR(got.restitution, exact, 2e-3 * exact) << zeta;
    EXPECT_GT(got.restitution, o.restitution());
  }
}

std::string name_of(const testing::TestParamInfo<std::tuple<int, std::string>>& given) {
  return fmt::format("{}In{}D", std::get<1>(given.param), std::get<0>(given.param));
}

INSTANTIATE_TEST_SUITE_P(Damping, HeadOn,
                         testing::Combine(testing::Values(2, 3),
                                          testing::Values("cn", "rate", "restitution")),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Damping, HeadOnClamped,
                         testing::Combine(testing::Values(2, 3), testing::Values("cn", "rate")),
                         name_of);

constexpr const char* kTwoMaterials = R"(
dimension = 2
[domain]
lo = [-1.0, -1.0]
hi = [1.0, 1.0]
[time]
step = 1e-5
steps = 1000000
[contact]
no_tension = false
[[material]]
name = "hard"
density = 1000.0
normal_stiffness = 4e5
normal_damping = 300.0
[[material]]
name = "soft"
density = 1000.0
normal_stiffness = 1e5
normal_damping = 100.0
[[particles]]
kind = "list"
material = "hard"
particle = [{ position = [-0.1, 0.0], velocity = [0.5, 0.0], radius = 0.1 }]
[[particles]]
kind = "list"
material = "soft"
particle = [{ position = [0.1, 0.0], velocity = [-0.5, 0.0], radius = 0.1 }]
)";

double restitution_of(const std::string& deck, double kn, double cn) {
  const double reduced = 0.5 * mass_of(2);
  const double zeta = 0.5 * cn / std::sqrt(kn * reduced);
  auto simulation = test::simulate(deck);
  simulation.run(static_cast<std::int64_t>(2.0 * kPi / std::sqrt(kn / reduced) / 1e-5));
  const double parting =
      test::particle(simulation, 2).velocity[0] - test::particle(simulation, 1).velocity[0];
  return parting / std::exp(-kPi * zeta / std::sqrt(1.0 - zeta * zeta));
}

TEST(Mixing, CollidesTwoMaterialsWithSpringsAndDashpotsInSeries) {
  EXPECT_NEAR(restitution_of(kTwoMaterials, 1.6e5, 150.0), 1.0, 1e-3);
}

TEST(Mixing, GivesWayToAnExplicitPair) {
  const std::string pair = R"(
[[pair]]
materials = ["soft", "hard"]
normal_stiffness = 2e5
normal_damping = 500.0
)";
  EXPECT_NEAR(restitution_of(kTwoMaterials + pair, 2e5, 500.0), 1.0, 2e-3);
}

}  // namespace
}  // namespace barchan
