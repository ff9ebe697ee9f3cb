// How errors shrink with the time step.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

constexpr double kPi = std::numbers::pi;

constexpr const char* kPair = R"(
dimension = 2
[domain]
lo = [-1.0, -1.0]
hi = [1.0, 1.0]
[time]
step = 1e-4
steps = 1000000
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e5
[[particles]]
kind = "list"
material = "m"
particle = [
  { position = [-0.1, 0.0], velocity = [0.5, 0.0], radius = 0.1 },
  { position = [0.1, 0.0], velocity = [-0.5, 0.0], radius = 0.1 },
]
)";

const double kMass = 1000.0 * kPi * 0.01;

/// Position error of a collision, at half of its contact time and long after it.
struct Errors {
  double during, after;
};
Errors collision_errors(int num_steps) {
  const double omega = std::sqrt(2.0 * 1e5 / kMass);
  const double contact = kPi / omega;
  auto simulation = test::simulate(kPair, {fmt::format("time.step={:.17g}", contact / num_steps)});
  simulation.run(num_steps / 2);
  const double during = test::particle(simulation, 2).position[0] - 0.1 + 0.5 / omega;
  simulation.run(num_steps / 2 + num_steps);
  const double after = test::particle(simulation, 2).position[0] - 0.1 - 0.5 * contact;
  return {during, after};
}

TEST(TimeStep, HalvedQuartersTheErrorOfACollision) {
  const Errors coarse = collision_errors(40), middle = collision_errors(80),
               fine = collision_errors(160);

  EXPECT_NEAR(coarse.during / middle.during, 4.0, 0.2);
  EXPECT_NEAR(middle.during / fine.during, 4.0, 0.1);
  EXPECT_LT(std::fabs(fine.after), 0.3 * std::fabs(middle.after));
  EXPECT_LT(std::fabs(middle.after), 0.3 * std::fabs(coarse.after));
}

double damped_error(int num_steps) {
  const double natural = std::sqrt(2.0 * 1e5 / kMass);
  const double decay = 0.3 * natural, omega = natural * std::sqrt(1.0 - 0.3 * 0.3);
  const double contact = kPi / omega, t = 0.5 * contact;
  auto simulation =
      test::simulate(kPair, {fmt::format("time.step={:.17g}", contact / num_steps),
                             fmt::format("material.m.normal_damping_rate={:.17g}", 2.0 * decay)});
  simulation.run(num_steps / 2);
  const double overlap = 0.2 - 2.0 * test::particle(simulation, 2).position[0];
  return overlap - std::exp(-decay * t) * std::sin(omega * t) / omega;
}

TEST(TimeStep, HalvedHalvesTheErrorOfADampedCollision) {
  // The dashpot sees the velocity of half a step earlier.
  const double coarse = damped_error(800), fine = damped_error(1600);

  EXPECT_NEAR(coarse / fine, 2.0, 0.05) << coarse << " " << fine;
  EXPECT_LT(std::fabs(fine), 1e-4);
}

/// A bonded pair set swinging along the bond, across it, or turning against each other.
double swing_error(const std::string& motion, double omega, int num_steps) {
  const double period = 2.0 * kPi / omega;
  auto simulation =
      test::simulate(kPair, {fmt::format("time.step={:.17g}", period / num_steps),
                             "bond=[{name='glue', young_modulus=1e6}]", "particles.1.bond=glue",
                             "particles.1.particle=[{ position=[-0.1, 0.0], radius=0.1 " + motion});
  double turned = 0.0;  // of the second one [rad]
  const double dt = simulation.model().time.step;
  for (int k = 0; k < num_steps / 8 * 3; ++k) {
    simulation.run(1);
    turned += dt * test::particle(simulation, 2).omega[2];
  }
  const double phase = omega * simulation.time();
  if (motion.find("omega") != std::string::npos) return turned - 0.01 / omega * std::sin(phase);
  return test::particle(simulation, 2).position[0] - 0.1 - 0.01 / omega * std::sin(phase);
}

TEST(TimeStep, HalvedQuartersTheErrorOfAStretchedBond) {
  const double omega = std::sqrt(2.0 * 1e6 / 0.2 * 0.2 / kMass);  // E·A/L and half the mass
  const std::string motion =
      ", velocity=[-0.01, 0.0] }, { position=[0.1, 0.0], radius=0.1, velocity=[0.01, 0.0] }]";

  const double coarse = swing_error(motion, omega, 80), fine = swing_error(motion, omega, 160);

  EXPECT_NEAR(coarse / fine, 4.0, 0.1) << coarse << " " << fine;
}

TEST(TimeStep, HalvedQuartersTheErrorOfABentBond) {
  const double inertia = 2.0 / 3.0 * 0.001;  // of the section
  const double omega = std::sqrt(2.0 * 1e6 / 0.2 * inertia / (0.5 * kMass * 0.01));
  const std::string motion = ", omega=-0.01 }, { position=[0.1, 0.0], radius=0.1, omega=0.01 }]";

  const double coarse = swing_error(motion, omega, 80), fine = swing_error(motion, omega, 160);

  EXPECT_NEAR(coarse / fine, 4.0, 0.1) << coarse << " " << fine;
}

}  // namespace
}  // namespace barchan
