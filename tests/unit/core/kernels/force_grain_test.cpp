#include <barchan/core/kernels/force_grain.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace barchan {
namespace {

/// Disks of 0.05 m and 1 kg/m² that lie in a box 4 m high.
Model soil() {
  Model m;
  m.domain.hi = Vec3(8.0, 4.0, 0.0);
  m.gravity = Vec3(0.0, -9.81, 0.0);
  m.materials = {{"soil", 126.0}};
  ContactConstants law;
  law.kn = 55e3;
  law.cn.constant = 650.0;
  law.mu = 0.5;
  m.contacts = {1, {law}, true};
  m.stages.resize(1);
  return m;
}

ParticleSet disks(double radius) {
  ParticleSet set;
  for (int p = 0; p < 3; ++p) {
    ParticleData d;
    d.id = p + 1;
    d.radius = radius;
    d.density = 126.0;
    d.position = Vec3(0.2 * p + 0.1, 0.1, 0.0);
    set.particles.push_back(d);
  }
  return set;
}

TEST(ForceGrain, IsAPowerOfTwoWithRoomForTheLargestContactAndFarBelowTheWeight) {
  const Model model = soil();
  const ParticleSet set = disks(0.05);

  const ForceGrain grain = force_grain(model, set);

  int exponent = 0;
  EXPECT_EQ(std::frexp(grain.size, &exponent), 0.5);
  EXPECT_GE(grain.most(), 55e3 * 0.05 * std::sqrt(1.25));
  EXPECT_GE(grain.most(), 650.0 * std::sqrt(2.0 * 9.81 * 0.1));
  EXPECT_LT(grain.size, 1e-11 * smallest_mass(model, set) * 9.81);
  EXPECT_EQ(grain.rounder() + 0.5 * grain.size, grain.rounder()) << "a tie goes to even";
  EXPECT_EQ((0.75 * grain.size + grain.rounder()) - grain.rounder(), grain.size);
  EXPECT_EQ((grain.most() + grain.rounder()) - grain.rounder(), grain.most());
  EXPECT_EQ((-grain.most() + grain.rounder()) - grain.rounder(), -grain.most());
}

TEST(ForceGrain, ScalesWithTheHeap) {
  for (const int k : {-200, -30, -1, 1, 30, 200}) {
    const double s = std::ldexp(1.0, k);  // lengths, and gravity, so that times stay
    Model model = soil();
    ParticleSet set = disks(0.05);
    const ForceGrain grain = force_grain(model, set);
    model.domain.hi *= s;
    model.gravity *= s;
    for (ParticleData& p : set.particles) {
      p.radius *= s;
      p.position *= s;
      p.density /= s * s;  // masses stay
    }

    EXPECT_EQ(force_grain(model, set).size, std::ldexp(grain.size, k)) << k;
  }
}

TEST(ForceGrain, HasRoomForAFallThroughTheWholeDomain) {
  Model model = soil();
  model.contacts.constants[0].cn.constant = 65e3;  // more than any spring of these disks gives
  ParticleSet set = disks(0.05);
  set.particles[0].position[1] = 4.0;
  EXPECT_GE(force_grain(model, set).most(), 65e3 * std::sqrt(2.0 * 9.81 * 4.0));
}

TEST(ForceGrain, HasRoomForAWallThatComes) {
  Model model = soil();
  model.walls.resize(1);
  model.walls[0].velocity = Vec3(300.0, 400.0, 0.0);
  EXPECT_GE(force_grain(model, disks(0.05)).most(), 650.0 * 2.0 * 500.0);
}

TEST(ForceGrain, HasRoomForHalfOfTheLargestForceFromEveryNeighbour) {
  for (const int dimension : {2, 3}) {
    Model model = soil();
    model.dimension = dimension;
    model.contacts.constants[0].cn = {};
    const double force = 55e3 * model.limits.overlap_error * 0.05,
                 neighbours = dimension == 2 ? 6 : 12;

    EXPECT_GE(force_grain(model, disks(0.05)).most(), neighbours * 0.5 * 1.5 * force);
    EXPECT_LT(force_grain(model, disks(0.05)).most(), 2.0 * neighbours * 0.5 * 1.5 * force);
  }
}

TEST(ForceGrain, IsCoarserForStifferLawsLargerGrainsAndFasterOnes) {
  const double size = force_grain(soil(), disks(0.05)).size;
  Model stiff = soil(), deep = soil(), free = soil();
  stiff.contacts.constants[0].kn *= 64.0;
  deep.limits.overlap_error = 0.02;
  free.limits.overlap_error = std::numeric_limits<double>::infinity();
  ParticleSet fast = disks(0.05);
  fast.particles[1].velocity[0] = 1e4;

  EXPECT_GT(force_grain(stiff, disks(0.05)).size, size);
  EXPECT_GT(force_grain(soil(), disks(3.2)).size, size);
  EXPECT_GT(force_grain(soil(), fast).size, size);
  EXPECT_LE(force_grain(deep, disks(0.05)).size, size);
  EXPECT_LE(force_grain(free, disks(0.05)).size, 4.0 * size);
}

TEST(ForceGrain, TakesMoreWhereTheDeckLetsLargerOverlapsPass) {
  Model model = soil();
  const double most = force_grain(model, disks(0.05)).most();
  model.limits.overlap_error = 64.0;

  EXPECT_GE(force_grain(model, disks(0.05)).most(), 32.0 * most);
}

TEST(ForceGrain, HoldsForDecksInWhichNothingCanPress) {
  Model model = soil();
  model.contacts.constants[0] = {};
  EXPECT_GT(force_grain(model, disks(0.05)).size, 0.0);
  EXPECT_GT(force_grain(model, {}).size, 0.0);
  EXPECT_EQ(coarse_grain_warning(force_grain(model, {}), model, {}), "");
}

TEST(ForceGrain, GrowsWithTheLimitOfARunThatContinues) {
  const ForceGrain grain{0x1p-40};

  EXPECT_EQ(grain_for_limit(grain, 0.5, 0.5).size, 0x1p-40);
  EXPECT_EQ(grain_for_limit(grain, 0.5, 0.1).size, 0x1p-40);
  EXPECT_GE(grain_for_limit(grain, 0.05, 10.0).size, 200 * 0x1p-40);
  EXPECT_GE(grain_for_limit(grain, 0.5, std::numeric_limits<double>::infinity()).size, 4 * 0x1p-40);
}

TEST(ForceGrain, IsToldAndWarnedOfAgainstTheSmallestWeight) {
  Model model = soil();
  ParticleSet set = disks(0.05);
  EXPECT_NE(describe(force_grain(model, set), model, set).find("of the smallest weight"),
            std::string::npos);
  EXPECT_EQ(coarse_grain_warning(force_grain(model, set), model, set), "");
  set.particles[0].radius = 1e-7;
  set.particles[1].radius = 50.0;
  const std::string warning = coarse_grain_warning(force_grain(model, set), model, set);
  EXPECT_NE(warning.find("limits.overlap_error"), std::string::npos) << warning;
  model.gravity = Vec3::Zero();
  EXPECT_NE(describe(force_grain(model, set), model, set).find("no gravity"), std::string::npos);
  EXPECT_EQ(coarse_grain_warning(force_grain(model, set), model, set), "");
}

}  // namespace
}  // namespace barchan
