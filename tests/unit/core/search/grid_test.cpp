#include <barchan/core/search/grid.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

Domain box(double x, double y, double z = 0.0) {
  Domain d;
  d.hi = Vec3(x, y, z);
  return d;
}

TEST(Grid, CellsAreAtLeastAsWideAsTheReach) {
  const Grid<3> grid(box(10.0, 3.2, 0.5), 1.1);
  EXPECT_EQ(grid.cells(0), 9);
  EXPECT_EQ(grid.cells(1), 2);
  EXPECT_EQ(grid.cells(2), 1);
  EXPECT_EQ(grid.slab_size(), 2);
}

TEST(Grid, KeysGrowSlowestAlongTheStripAxis) {
  Domain d = box(4.0, 6.0, 5.0);
  d.strip_axis = 1;
  const Grid<3> grid(d, 1.0);
  const double x[3] = {2.5, 3.5, 4.5};

  EXPECT_EQ(grid.axis(0), 1);
  EXPECT_EQ(grid.num_slabs(), 6);
  EXPECT_EQ(grid.slab_size(), 20);
  EXPECT_EQ(grid.coordinate(x, 0), 3);
  EXPECT_EQ(grid.key(x), 3 * 20 + 2 * 5 + 4);
}

TEST(Grid, OutsidePositionsBelongToTheOutermostCells) {
  const Grid<2> grid(box(4.0, 4.0), 1.0);
  const double below[2] = {-3.0, 9.0}, nowhere[2] = {std::numeric_limits<double>::quiet_NaN(), 1.5};
  EXPECT_EQ(grid.key(below), 3);
  EXPECT_EQ(grid.key(nowhere), 1);
  EXPECT_FALSE(grid.contains(below));
}

TEST(Grid, WrapBringsAnyPositionIntoThePeriodicBox) {
  Domain d = box(3.0, 3.0);
  d.lo = Vec3(-1.0, 0.0, 0.0);
  d.periodic = {true, false, false};
  const Grid<2> grid(d, 0.9);
  for (const double x : {-1.0, 2.999, 3.0, -1.0 - 1e-17, -5.0, 11.25, std::nextafter(-1.0, -2.0),
                         std::nextafter(3.0, 0.0)}) {
    double p[2] = {x, 7.0};

    grid.wrap(p);

    EXPECT_GE(p[0], -1.0) << x;
    EXPECT_LT(p[0], 3.0) << x;
    EXPECT_NEAR(std::remainder(p[0] - x, 4.0), 0.0, 1e-14) << x;
    EXPECT_EQ(p[1], 7.0);
  }
}

TEST(Grid, HasCellsOfTheReachInADomainOfAnySize) {
  const Grid<3> grid(box(1000.0, 1000.0, 1000.0), 0.1);
  EXPECT_EQ(grid.num_slabs(), 10000);
  EXPECT_EQ(grid.slab_size(), std::int64_t{10000} * 10000);
  const double corner[] = {999.99, 999.99, 999.99};
  EXPECT_EQ(grid.key(corner), std::int64_t{10000} * 10000 * 10000 - 1);
}

TEST(Grid, RefusesAPeriodicAxisShorterThanTwiceTheReach) {
  Domain d = box(1.9, 5.0);
  EXPECT_NO_THROW(Grid<2>(d, 1.0));
  d.periodic[0] = true;
  d.place = {"deck.toml", 4, 1};
  try {
    Grid<2>(d, 1.0);
    FAIL() << "too narrow a period is taken";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("deck.toml:4:1: ", 0), 0u) << error.what();
  }
}

}  // namespace
}  // namespace barchan
