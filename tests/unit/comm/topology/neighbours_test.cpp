#include <barchan/comm/topology/neighbours.hpp>

#include <gtest/gtest.h>

namespace barchan {
namespace {

TEST(Neighbours, EndAtTheDomainWhenItIsOpen) {
  EXPECT_EQ(strip_neighbours(0, 3, false).rank(kLeftLink), -1);
  EXPECT_EQ(strip_neighbours(0, 3, false).rank(kRightLink), 1);
  EXPECT_EQ(strip_neighbours(2, 3, false).rank(kRightLink), -1);
}

TEST(Neighbours, CloseTheRingWhenItIsPeriodic) {
  EXPECT_EQ(strip_neighbours(0, 3, true).rank(kLeftLink), 2);
  EXPECT_EQ(strip_neighbours(2, 3, true).rank(kRightLink), 0);
}

TEST(Neighbours, AreTheSameRankTwiceInARingOfTwo) {
  EXPECT_EQ(strip_neighbours(0, 2, true).rank(kLeftLink), 1);
  EXPECT_EQ(strip_neighbours(0, 2, true).rank(kRightLink), 1);
}

TEST(Neighbours, ALoneStripHasNone) {
  EXPECT_FALSE(strip_neighbours(0, 1, true).has(kLeftLink));
  EXPECT_FALSE(strip_neighbours(0, 1, true).has(kRightLink));
}

}  // namespace
}  // namespace barchan
