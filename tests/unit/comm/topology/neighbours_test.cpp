#include <barchan/comm/topology/neighbours.hpp>

#include <gtest/gtest.h>

namespace barchan {
namespace {

TEST(Neighbours, EndAtTheDomainWhenItIsOpen) {
  EXPECT_EQ(strip_neighbours(0, 3, false).left, -1);
  EXPECT_EQ(strip_neighbours(0, 3, false).right, 1);
  EXPECT_EQ(strip_neighbours(2, 3, false).right, -1);
}

TEST(Neighbours, CloseTheRingWhenItIsPeriodic) {
  EXPECT_EQ(strip_neighbours(0, 3, true).left, 2);
  EXPECT_EQ(strip_neighbours(2, 3, true).right, 0);
}

TEST(Neighbours, AreTheSameRankTwiceInARingOfTwo) {
  EXPECT_EQ(strip_neighbours(0, 2, true).left, 1);
  EXPECT_EQ(strip_neighbours(0, 2, true).right, 1);
}

TEST(Neighbours, ALoneStripHasNone) {
  EXPECT_FALSE(strip_neighbours(0, 1, true).has(Side::Left));
  EXPECT_FALSE(strip_neighbours(0, 1, true).has(Side::Right));
}

}  // namespace
}  // namespace barchan
