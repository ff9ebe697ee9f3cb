#include <barchan/tasks/plates.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "support/mpi_session.hpp"

namespace barchan {
namespace {

constexpr double kDt = 1e-3;

WallSpec plate() {
  WallSpec s;
  s.kind = WallKind::Plate;
  s.normal = Vec3(0.0, -1.0, 0.0);
  s.width = 2.0;
  s.is_loaded = true;
  s.load = 30.0;
  s.mass = 4.0;
  return s;
}

/// One step with this force of the particles on the plate. @return the plate's work
double step(Plates& plates, std::vector<WallState>& states, const Vec3& force,
            int appears_in = -1) {
  std::vector<WallSums> sums(states.size()), works(states.size());
  for (int c = 0; c < 3; ++c) sums[0].force[c].add(force[c]);
  if (plates.are_driven(states)) {
    plates.begin(sums);
    plates.kick(states, appears_in, works);
  }
  plates.move(states);
  return works[0].work.value();
}

TEST(Plates, FallWithTheirLoadAlongTheNormal) {
  const std::vector<WallSpec> specs{plate()};
  std::vector<WallState> states(1);
  Plates plates(Communicator(test::world()), specs, kDt);

  for (int n = 0; n < 10; ++n) (void)step(plates, states, Vec3::Zero(), n == 0 ? 0 : -1);

  const double acceleration = 30.0 * 2.0 / 4.0, t = 10 * kDt;
  EXPECT_NEAR(states[0].velocity[1], -acceleration * (t - 0.5 * kDt), 1e-12);  // half a step behind
  EXPECT_NEAR(states[0].point[1], -0.5 * acceleration * t * t, 1e-12);
  EXPECT_EQ(states[0].point[0], 0.0);
}

TEST(Plates, FeelTheForceOfTheSameStep) {
  const std::vector<WallSpec> specs{plate()};
  std::vector<WallState> states(1);
  Plates plates(Communicator(test::world()), specs, kDt);

  (void)step(plates, states, Vec3(5.0, 60.0, 0.0));  // as much as the load
  EXPECT_EQ(states[0].velocity[1], 0.0);
  (void)step(plates, states, Vec3::Zero());

  EXPECT_LT(states[0].velocity[1], 0.0);
  EXPECT_EQ(states[0].velocity[0], 0.0);
}

TEST(Plates, LoseAsWorkWhatTheyLoseInEnergy) {
  WallSpec spec = plate();
  spec.load = 0.0;
  const std::vector<WallSpec> specs{spec};
  std::vector<WallState> states(1);
  states[0].velocity = Vec3(0.0, -3.0, 0.0);
  Plates plates(Communicator(test::world()), specs, kDt);

  double work = 0.0;
  for (int n = 0; n < 20; ++n) work += step(plates, states, Vec3(7.0, 50.0 * n, 0.0));

  const double v = states[0].velocity[1];
  EXPECT_NEAR(work, 0.5 * 4.0 * (9.0 - v * v), 1e-12);
  EXPECT_GT(work, 1.0);
}

TEST(Plates, WithDampingReachASteadySpeed) {
  WallSpec spec = plate();
  spec.damping = 100.0;
  const std::vector<WallSpec> specs{spec};
  std::vector<WallState> states(1);
  Plates plates(Communicator(test::world()), specs, kDt);

  for (int n = 0; n < 1000; ++n) (void)step(plates, states, Vec3::Zero());

  EXPECT_NEAR(states[0].velocity[1], -0.6, 1e-9);
}

TEST(Plates, WithDampingSlowDownToSecondOrder) {
  WallSpec spec = plate();
  spec.load = 0.0;
  spec.damping = 0.1 * spec.mass / kDt;
  const std::vector<WallSpec> specs{spec};
  std::vector<WallState> states(1);
  states[0].velocity = Vec3(0.0, -3.0, 0.0);
  Plates plates(Communicator(test::world()), specs, kDt);

  for (int n = 0; n < 10; ++n) (void)step(plates, states, Vec3::Zero());

  EXPECT_NEAR(states[0].velocity[1], -3.0 * std::exp(-1.0), 3.0 * 1e-3);
}

TEST(Plates, WaitUntilTheyAreActiveWhileGivenVelocitiesAlwaysMove) {
  WallSpec piston;
  const std::vector<WallSpec> specs{plate(), piston};
  std::vector<WallState> states(2);
  states[0].is_active = false;
  states[1].velocity = Vec3(0.5, 0.0, 0.0);
  Plates plates(Communicator(test::world()), specs, kDt);

  for (int n = 0; n < 4; ++n) (void)step(plates, states, Vec3::Zero());

  EXPECT_EQ(states[0].point[1], 0.0);
  EXPECT_NEAR(states[1].point[0], 0.5 * 4 * kDt, 1e-15);
}

}  // namespace
}  // namespace barchan
