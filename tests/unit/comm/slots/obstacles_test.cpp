#include <barchan/comm/slots/obstacles.hpp>

#include <gtest/gtest.h>

namespace barchan {
namespace {

TEST(Obstacles, TellEachReasonOnceWithAllExchangesThatItHoldsFor) {
  const std::vector<ExchangeObstacle> obstacles{{"put-flag", "no window (ask for one)"},
                                                {"shared", "two nodes"},
                                                {"get", "no window (ask for one)"}};

  const std::vector<std::string> lines = lines_of(obstacles);

  EXPECT_EQ(lines, (std::vector<std::string>{"put-flag, get: no window (ask for one)",
                                             "shared: two nodes"}));
}

TEST(Obstacles, AreNotToldWhereThereAreNone) {
  EXPECT_TRUE(lines_of({}).empty());
}

}  // namespace
}  // namespace barchan
