#include <barchan/core/generators/hole_volume.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <barchan/core/base/random.hpp>
#include <barchan/core/generators/grain.hpp>

namespace barchan {
namespace {

using std::numbers::pi;

PairSpace box_of(int dimension, const Vec3& lo, const Vec3& hi) {
  return {dimension, lo, hi, {}};
}

/// Area that two equal disks share.
double lens(double radius, double distance) {
  return 2.0 * radius * radius * std::acos(0.5 * distance / radius) -
         0.5 * distance * std::sqrt(4.0 * radius * radius - distance * distance);
}

/// Volume that two equal balls share.
double lens_3d(double radius, double distance) {
  return pi * (4.0 * radius + distance) * std::pow(2.0 * radius - distance, 2) / 12.0;
}

TEST(HoleVolume, OfAHoleInTheBoxIsItsOwn) {
  EXPECT_EQ(hole_volume(box_of(2, {0, 0, 0}, {4, 4, 0}), {{{{2, 2, 0}, 0.8}}}),
            solid_volume(0.8, 2));
  EXPECT_EQ(hole_volume(box_of(3, {0, 0, 0}, {4, 4, 4}), {{{{2, 2, 2}, 0.8}}}),
            solid_volume(0.8, 3));
}

TEST(HoleVolume, CountsWhatLiesInTheBox) {
  const PairSpace square = box_of(2, {0, 0, 0}, {4, 4, 0});
  EXPECT_NEAR(hole_volume(square, {{{{0, 2, 0}, 1}}}), pi / 2, 1e-14);
  EXPECT_NEAR(hole_volume(square, {{{{4, 4, 0}, 1}}}), pi / 4, 1e-14);
  EXPECT_NEAR(hole_volume(square, {{{{2, -0.5, 0}, 1}}}), pi / 3 - std::sqrt(3.0) / 4, 1e-14);
  EXPECT_EQ(hole_volume(square, {{{{9, 2, 0}, 1}}}), 0.0);
  EXPECT_NEAR(hole_volume(square, {{{{2, 2, 0}, 9}}}), 16.0, 1e-13);

  const PairSpace cube = box_of(3, {0, 0, 0}, {4, 4, 4});
  EXPECT_NEAR(hole_volume(cube, {{{{0, 2, 2}, 1}}}), 2 * pi / 3, 1e-9);
  EXPECT_NEAR(hole_volume(cube, {{{{4, 0, 4}, 1}}}), pi / 6, 1e-9);
  EXPECT_NEAR(hole_volume(cube, {{{{2, 2, -0.5}, 1}}}), pi * 0.25 * 2.5 / 3, 1e-9);
  EXPECT_NEAR(hole_volume(cube, {{{{2, 2, 2}, 9}}}), 64.0, 1e-8);
}

TEST(HoleVolume, CountsWhatSeveralHolesShareOnce) {
  const PairSpace square = box_of(2, {0, 0, 0}, {9, 9, 0});
  const Hole disk{{3, 4, 0}, 1};
  EXPECT_NEAR(hole_volume(square, {{disk, disk}}), pi, 1e-14);
  EXPECT_NEAR(hole_volume(square, {{disk, {{3.2, 4.1, 0}, 0.5}}}), pi, 1e-14);
  EXPECT_NEAR(hole_volume(square, {{disk, {{4.2, 4, 0}, 1}}}), 2 * pi - lens(1, 1.2), 1e-13);
  EXPECT_NEAR(hole_volume(square, {{disk, {{3, 5.2, 0}, 1}, {{7, 7, 0}, 1}}}),
              3 * pi - lens(1, 1.2), 1e-13);

  const PairSpace cube = box_of(3, {0, 0, 0}, {9, 9, 9});
  const Hole ball{{3, 4, 5}, 1};
  const Vec3 aslant = Vec3(1, -2, 2) / 3;
  EXPECT_NEAR(hole_volume(cube, {{ball, ball}}), solid_volume(1, 3), 1e-8);
  EXPECT_NEAR(hole_volume(cube, {{ball, {ball.center + 1.2 * aslant, 1}}}),
              2 * solid_volume(1, 3) - lens_3d(1, 1.2), 1e-8);
}

TEST(HoleVolume, IsTheSameWhereTheBoxIsCutInTwo) {
  for (const int dimension : {2, 3}) {
    CounterRandom random(3, 0);
    std::vector<Hole> holes;
    for (int i = 0; i < 12; ++i) {
      Hole hole{Vec3::Zero(), random.uniform(0.3, 1.2)};
      for (int axis = 0; axis < dimension; ++axis) hole.center[axis] = random.uniform(-0.5, 4.5);
      holes.push_back(hole);
    }
    const Vec3 hi(4, 4, dimension == 2 ? 0 : 4);
    const double whole = hole_volume(box_of(dimension, {0, 0, 0}, hi), holes);
    for (int axis = 0; axis < dimension; ++axis) {
      Vec3 cut_hi = hi, cut_lo = Vec3::Zero();
      cut_hi[axis] = cut_lo[axis] = 1.7;
      const double sum = hole_volume(box_of(dimension, {0, 0, 0}, cut_hi), holes) +
                         hole_volume(box_of(dimension, cut_lo, hi), holes);
      EXPECT_NEAR(sum, whole, 1e-7) << dimension << " " << axis;
    }
    EXPECT_GT(whole, 0.15 * std::pow(4.0, dimension));
    EXPECT_LT(whole, std::pow(4.0, dimension));
  }
}

TEST(HoleVolume, CountsImagesAcrossPeriodicAxes) {
  PairSpace square = box_of(2, {0, 0, 0}, {4, 4, 0});
  square.periodic = {true, true, false};
  EXPECT_NEAR(hole_volume(square, {{{{0, 0, 0}, 1}}}), pi, 1e-14);
  EXPECT_NEAR(hole_volume(square, {{{{-3, 7, 0}, 1}}}), pi, 1e-14);
  EXPECT_NEAR(hole_volume(square, {{{{0.4, 2, 0}, 1}, {{3.2, 2, 0}, 1}}}), 2 * pi - lens(1, 1.2),
              1e-13);

  PairSpace cube = box_of(3, {0, 0, 0}, {4, 4, 4});
  cube.periodic = {false, true, true};
  EXPECT_NEAR(hole_volume(cube, {{{{0, 0, 0}, 1}}}), 2 * pi / 3, 1e-8);
}

TEST(HoleVolume, CopesWithALongRowOfBalls) {
  std::vector<Hole> row;
  for (int i = 0; i < 200; ++i) row.push_back({Vec3(0.11, 0.1, 0.13) * i + Vec3(1, 1, 1), 0.5});
  const double gap = Vec3(0.11, 0.1, 0.13).norm();

  const double volume = hole_volume(box_of(3, {0, 0, 0}, {40, 40, 40}), row);

  EXPECT_NEAR(volume, solid_volume(0.5, 3) + 199 * (solid_volume(0.5, 3) - lens_3d(0.5, gap)),
              1e-6);
}

}  // namespace
}  // namespace barchan
