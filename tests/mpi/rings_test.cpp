// Diameters of rings: around a periodic axis, and of rings whose disks leave the domain.
#include <gtest/gtest.h>

#include <cmath>

#include <barchan/tasks/results/rings.hpp>

#include "model_parts.hpp"
#include "running.hpp"

namespace barchan::test {
namespace {

constexpr double kStep = 2e-3;
constexpr int kDisks = 16;

/// Disks on a circle that fly along x at 5 m/s and touch nobody.
ParticleSet flying_ring(const Vec3& center, double radius) {
  ParticleSet set;
  for (int k = 0; k < kDisks; ++k) {
    const double angle = 2.0 * 3.14159265358979 * k / kDisks;
    ParticleData p;
    p.id = k + 1;
    p.radius = 0.05;
    p.density = 100.0;
    p.position = center + radius * Vec3(std::cos(angle), std::sin(angle), 0.0);
    p.velocity = Vec3(5.0, 0.0, 0.0);
    set.particles.push_back(p);
  }
  return set;
}

Model flat_box() {
  Model m = plain_model(2, 4.0, 4.0);
  m.time.step = kStep;
  m.gravity = Vec3::Zero();
  m.search.skin = 0.1;
  return m;
}

const std::vector<Ring> kRing{{"ring1", 1, kDisks}};

/// Centres move back by whole periods, as generators leave them.
void wrap_along_x(ParticleSet& set, double period) {
  for (ParticleData& p : set.particles)
    p.position[0] -= period * std::floor(p.position[0] / period);
}

TEST(RingDiameters, StayTheSameAroundAPeriodicAxis) {
  Model m = flat_box();
  m.domain.periodic = {true, false, false};
  ParticleSet set = flying_ring({3.9, 2.0, 0.0}, 1.6);
  wrap_along_x(set, 4.0);
  Simulation sim(m, set, MPI_COMM_WORLD, with_threads(1));

  for (int piece = 0; piece < 10; ++piece) {
    const auto diameters = ring_diameters(sim, kRing);
    ASSERT_EQ(diameters.size(), 2u);
    EXPECT_NEAR(*diameters[0], 3.2, 1e-9) << "step " << sim.step();
    EXPECT_NEAR(*diameters[1], 3.2, 1e-9) << "step " << sim.step();
    sim.run(50);
  }
}

TEST(RingDiameters, AreNoneOnceAllDisksAreDeleted) {
  Model m = flat_box();
  m.domain.outside = OutsidePolicy::Delete;
  Simulation sim(m, flying_ring({3.0, 2.0, 0.0}, 0.8), MPI_COMM_WORLD, with_threads(1));
  EXPECT_TRUE(ring_diameters(sim, kRing)[0].has_value());

  sim.run(600);

  EXPECT_EQ(sim.num_particles(), 0);
  EXPECT_EQ(ring_diameters(sim, kRing), std::vector<std::optional<double>>(2));
}

}  // namespace
}  // namespace barchan::test
