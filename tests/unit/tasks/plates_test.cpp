#include <barchan/tasks/plates.hpp>

#include <gtest/gtest.h>

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

/// One step with this force of the particles on the plate.
void step(Plates& plates, std::vector<WallState>& states, std::int64_t n, const Vec3& force) {
  plates.drive(states, n);
  std::vector<WallSums> sums(states.size());
  for (int c = 0; c < 3; ++c) sums[0].force[c].add(force[c]);
  if (plates.needs_forces(states)) plates.collect(sums, n);
  plates.move(states);
}

TEST(Plates, FallWithTheirLoadAlongTheNormal) {
  const std::vector<WallSpec> specs{plate()};
  std::vector<WallState> states(1);
  Plates plates(Communicator(test::world()), specs, kDt);

  for (int n = 0; n < 10; ++n) step(plates, states, n, Vec3::Zero());

  const double acceleration = 30.0 * 2.0 / 4.0;
  EXPECT_NEAR(states[0].velocity[1], -acceleration * 10 * kDt, 1e-12);
  EXPECT_NEAR(states[0].point[1], -acceleration * kDt * kDt * 55, 1e-12);
  EXPECT_EQ(states[0].point[0], 0.0);
}

TEST(Plates, FeelTheForceOfTwoStepsAgo) {
  const std::vector<WallSpec> specs{plate()};
  std::vector<WallState> states(1);
  Plates plates(Communicator(test::world()), specs, kDt);

  step(plates, states, 0, Vec3(5.0, 60.0, 0.0));  // as much as the load
  step(plates, states, 1, Vec3::Zero());
  const double before = states[0].velocity[1];
  step(plates, states, 2, Vec3::Zero());
  const double with_force = states[0].velocity[1];
  step(plates, states, 3, Vec3::Zero());

  EXPECT_EQ(with_force, before);
  EXPECT_LT(states[0].velocity[1], with_force);
  EXPECT_EQ(states[0].velocity[0], 0.0);
}

TEST(Plates, WithDampingReachASteadySpeed) {
  WallSpec spec = plate();
  spec.damping = 100.0;
  const std::vector<WallSpec> specs{spec};
  std::vector<WallState> states(1);
  Plates plates(Communicator(test::world()), specs, kDt);

  for (int n = 0; n < 1000; ++n) step(plates, states, n, Vec3::Zero());

  EXPECT_NEAR(states[0].velocity[1], -0.6, 1e-9);
}

TEST(Plates, WaitUntilTheyAreActiveWhileGivenVelocitiesAlwaysMove) {
  WallSpec piston;
  const std::vector<WallSpec> specs{plate(), piston};
  std::vector<WallState> states(2);
  states[0].is_active = false;
  states[1].velocity = Vec3(0.5, 0.0, 0.0);
  Plates plates(Communicator(test::world()), specs, kDt);

  for (int n = 0; n < 4; ++n) step(plates, states, n, Vec3::Zero());

  EXPECT_EQ(states[0].point[1], 0.0);
  EXPECT_NEAR(states[1].point[0], 0.5 * 4 * kDt, 1e-15);
}

}  // namespace
}  // namespace barchan
