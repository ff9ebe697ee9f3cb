#include <barchan/core/links/wall_shape.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace barchan {
namespace {

WallSpec spec_of(WallKind kind, const Vec3& normal, double width = 0.0, double depth = 0.0) {
  WallSpec s;
  s.kind = kind;
  s.normal = normal;
  s.width = width;
  s.depth = depth;
  return s;
}

PeriodicBox box_of(double x, double y = 0.0, double z = 0.0) {
  PeriodicBox box;
  const double length[3] = {x, y, z};
  for (int c = 0; c < 3; ++c) {
    if (length[c] > 0.0) box.length[c] = length[c], box.inverse[c] = 1.0 / length[c];
  }
  return box;
}

template <int Dim>
void expect_foot(const WallSpec& spec, const Vec3& point, const Vec3& x, double distance,
                 const Vec3& nearest, const PeriodicBox& box = {}) {
  const WallFoot foot = WallShape<Dim>(spec, box).foot(point, x.data());

  EXPECT_NEAR(foot.distance, distance, 1e-12);
  for (int c = 0; c < Dim; ++c)
    EXPECT_NEAR(x[c] + foot.to_foot[c], nearest[c], 1e-12) << "component " << c;
}

TEST(WallShape, PlaneIsNearestAtTheFootOfThePerpendicular) {
  const double h = std::sqrt(0.5);
  expect_foot<2>(spec_of(WallKind::Plane, {0.0, 1.0, 0.0}), {5.0, 1.0, 0.0}, {2.0, 1.25, 0.0}, 0.25,
                 {2.0, 1.0, 0.0});
  expect_foot<2>(spec_of(WallKind::Plane, {0.0, 1.0, 0.0}), {5.0, 1.0, 0.0}, {2.0, 0.6, 0.0}, -0.4,
                 {2.0, 1.0, 0.0});  // behind
  expect_foot<2>(spec_of(WallKind::Plane, {h, h, 0.0}), {0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, 2.0 * h,
                 {0.0, 0.0, 0.0});
  expect_foot<3>(spec_of(WallKind::Plane, {0.0, 0.0, -1.0}), {0.0, 0.0, 3.0}, {1.0, 2.0, 2.5}, 0.5,
                 {1.0, 2.0, 3.0});
}

TEST(WallShape, PlateIn2DIsASegment) {
  const WallSpec plate = spec_of(WallKind::Plate, {0.0, -1.0, 0.0}, 2.0);
  const Vec3 middle(5.0, 3.0, 0.0);
  expect_foot<2>(plate, middle, {5.5, 2.0, 0.0}, 1.0, {5.5, 3.0, 0.0});  // below its face
  expect_foot<2>(plate, middle, {4.5, 3.5, 0.0}, 0.5, {4.5, 3.0, 0.0});  // above: from either side
  expect_foot<2>(plate, middle, {9.0, 3.0, 0.0}, 3.0, {6.0, 3.0, 0.0});  // in its line
  expect_foot<2>(plate, middle, {6.3, 2.6, 0.0}, 0.5, {6.0, 3.0, 0.0});  // at its right edge
  expect_foot<2>(plate, middle, {3.6, 3.3, 0.0}, 0.5, {4.0, 3.0, 0.0});  // at its left edge
}

TEST(WallShape, PlateIn3DIsARectangle) {
  // Width along x: the axis least aligned with the normal comes first.
  const WallSpec plate = spec_of(WallKind::Plate, {0.0, 0.0, 1.0}, 2.0, 4.0);
  const Vec3 middle(0.0, 0.0, 1.0);
  expect_foot<3>(plate, middle, {0.5, 1.5, 1.5}, 0.5, {0.5, 1.5, 1.0});
  expect_foot<3>(plate, middle, {1.3, 0.5, 1.4}, 0.5, {1.0, 0.5, 1.0});      // an edge
  expect_foot<3>(plate, middle, {-0.2, -2.3, 0.6}, 0.5, {-0.2, -2.0, 1.0});  // another, from below
  expect_foot<3>(plate, middle, {1.0 + 2.0, 2.0 + 2.0, 1.0 + 1.0}, 3.0,
                 {1.0, 2.0, 1.0});  // a corner
}

TEST(WallShape, PlateActsAcrossPeriodicFaces) {
  const WallSpec upright = spec_of(WallKind::Plate, {-1.0, 0.0, 0.0}, 0.6);
  const PeriodicBox box = box_of(1.0);
  expect_foot<2>(upright, {0.02, 0.5, 0.0}, {0.95, 0.5, 0.0}, 0.07, {1.02, 0.5, 0.0}, box);
  expect_foot<2>(upright, {0.98, 0.5, 0.0}, {0.05, 0.5, 0.0}, 0.07, {-0.02, 0.5, 0.0}, box);
  expect_foot<2>(upright, {7.98, 0.5, 0.0}, {0.05, 0.5, 0.0}, 0.07, {-0.02, 0.5, 0.0},
                 box);  // moved
  // Its edge across the face beside it.
  expect_foot<2>(spec_of(WallKind::Plate, {0.0, 1.0, 0.0}, 0.6), {0.8, 0.5, 0.0}, {0.05, 0.5, 0.0},
                 0.0, {0.05, 0.5, 0.0}, box);
  expect_foot<3>(spec_of(WallKind::Plate, {0.0, 0.0, 1.0}, 0.4, 0.4), {0.1, 0.9, 0.5},
                 {0.95, 0.05, 0.6}, 0.1, {0.95, 0.05, 0.5}, box_of(1.0, 1.0));
}

/// Distance to a tilted plate, by all images there may be.
TEST(WallShape, NearestOfAllImagesIsWhatEveryImageTriedGives) {
  const double c = std::cos(0.4), s = std::sin(0.4);
  const WallShape<2> shape(spec_of(WallKind::Plate, {-s, c, 0.0}, 1.7), box_of(1.0, 1.5));
  const Vec3 point(0.3, 0.2, 0.0);
  for (int k = 0; k < 200; ++k) {
    const double x[2] = {std::fmod(0.37 * k, 1.0), std::fmod(0.73 * k, 1.5)};
    double least = 10.0;
    std::vector<WallImage> near;
    for (std::int32_t i = -3; i <= 3; ++i) {
      for (std::int32_t j = -3; j <= 3; ++j) {
        const double d = shape.foot(point, {i, j, 0}, x).distance;
        least = std::min(least, d);
        if (d < 0.3) near.push_back({i, j, 0});
      }
    }
    std::vector<WallImage> found;
    shape.for_each_near(point, x, 0.3, [&](const WallImage& image) { found.push_back(image); });

    EXPECT_EQ(shape.foot(point, x).distance, least);
    EXPECT_EQ(found, near);
  }
}

TEST(WallShape, PlateAsWideAsTheBoxHasNoSeam) {
  const WallShape<2> lid(spec_of(WallKind::Plate, {0.0, 1.0, 0.0}, 0.3), box_of(0.1 + 0.2));
  for (const double x : {0.0, 0.01, 0.15, 0.29, 0.3}) {
    const double at[2] = {x, 0.7};
    int images = 0;
    lid.for_each_near({0.1, 0.5, 0.0}, at, 0.3, [&](const WallImage&) { ++images; });
    EXPECT_EQ(images, 1) << x;
    EXPECT_NEAR(lid.foot({0.1, 0.5, 0.0}, at).distance, 0.2, 1e-15) << x;
  }
  const WallShape<3> strip(spec_of(WallKind::Plate, {0.0, 0.0, 1.0}, 0.4, 2.0), box_of(1.0, 2.0));
  const double at[3] = {0.95, 1.99, 0.3};
  int images = 0;
  strip.for_each_near({0.1, 1.0, 0.0}, at, 0.4, [&](const WallImage&) { ++images; });
  EXPECT_EQ(images, 1);
}

TEST(WallShape, PositionInTheGapOfAPlateThatIsAlmostAsWideTouchesBothEnds) {
  const WallShape<2> lid(spec_of(WallKind::Plate, {0.0, 1.0, 0.0}, 0.9), box_of(1.0));
  const double at[2] = {0.0, 0.5};
  std::vector<WallImage> images;
  lid.for_each_near({0.5, 0.5, 0.0}, at, 0.1, [&](const WallImage& i) { images.push_back(i); });

  EXPECT_EQ(images, (std::vector<WallImage>{{-1, 0, 0}, {0, 0, 0}}));
}

TEST(WallShape, ImageStaysTheSameThroughAWrap) {
  const WallShape<2> shape(spec_of(WallKind::Plate, {0.0, 1.0, 0.0}, 0.5), box_of(1.0, 2.0));
  const Vec3 point(0.9, 1.9, 0.0);
  const double before[2] = {1.05, -0.1}, after[2] = {0.05, 1.9};
  const WallImage image{0, -1, 0};

  const WallImage seen = shape.seen_after(image, before, after);

  EXPECT_EQ(seen, (WallImage{-1, 0, 0}));
  EXPECT_NEAR(shape.foot(point, seen, after).distance, shape.foot(point, image, before).distance,
              1e-15);
}

TEST(WallShape, ArmIsTheSameOfEveryImage) {
  const WallShape<2> plate(spec_of(WallKind::Plate, {0.0, 1.0, 0.0}, 0.5), box_of(1.0));
  const WallShape<2> floor(spec_of(WallKind::Plane, {0.0, 1.0, 0.0}), box_of(1.0));
  const double low[2] = {0.05, 0.1}, high[2] = {1.05, 0.1};

  const Vec3 point(0.9, 0.0, 0.0);
  const auto arm = [&](const WallShape<2>& shape, const WallImage& image, const double* x) {
    return shape.arm(point, image, x, shape.foot(point, image, x))[0];
  };
  EXPECT_NEAR(arm(plate, {-1, 0, 0}, low), 0.15, 1e-15);
  EXPECT_NEAR(arm(plate, {0, 0, 0}, high), 0.15, 1e-15);
  EXPECT_NEAR(arm(floor, {0, 0, 0}, low), 0.15, 1e-15);
}

}  // namespace
}  // namespace barchan
