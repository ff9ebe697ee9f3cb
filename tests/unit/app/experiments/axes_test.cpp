#include <barchan/app/experiments/axes.hpp>

#include <gtest/gtest.h>

#include <barchan/core/base/error.hpp>

namespace barchan::app {
namespace {

TEST(Axes, MakeEveryCombinationOnce) {
  const auto points = combinations({{"ranks", {"1", "2"}}, {"exchange", {"get", "isend", "pscw"}}});

  ASSERT_EQ(points.size(), 6U);
  EXPECT_EQ(text_of(points[0]), "ranks=1,exchange=get");
  EXPECT_EQ(text_of(points[5]), "ranks=2,exchange=pscw");
  EXPECT_EQ(varied_axes(points), (std::vector<std::string>{"ranks", "exchange"}));
}

TEST(Axes, SplitLeavesBracketsAndQuotesWhole) {
  EXPECT_EQ(split("[1,2],[3,4],'a,b'", ','), (std::vector<std::string>{"[1,2]", "[3,4]", "'a,b'"}));
}

TEST(Axes, FolderNamesOfDifferentPointsDiffer) {
  const std::string text(300, 'x');

  EXPECT_EQ(folder_name(parse_point("ranks=2,exchange=shared+get")), "ranks=2,exchange=shared+get");
  EXPECT_NE(folder_name(parse_point("barchan=a/b")), folder_name(parse_point("barchan=a_b")));
  EXPECT_NE(folder_name(parse_point("a=" + text + "1")),
            folder_name(parse_point("a=" + text + "2")));
  EXPECT_LT(folder_name(parse_point("a=" + text)).size(), 255U);
}

TEST(Axes, ChangingAndDroppingValuesLeavesTheOthers) {
  const Point point = parse_point("ranks=2,exchange=get,delay=0");

  EXPECT_EQ(text_of(with(point, parse_point("delay=1ms"))), "ranks=2,exchange=get,delay=1ms");
  EXPECT_EQ(text_of(without(point, parse_point("exchange=any"))), "ranks=2,delay=0");
  EXPECT_TRUE(has(point, parse_point("delay=0,ranks=2")));
  EXPECT_FALSE(has(point, parse_point("delay=1ms")));
}

TEST(Axes, APointNeedsValues) {
  EXPECT_THROW((void)parse_point("exchange"), InputError);
  EXPECT_THROW((void)parse_point("exchange="), InputError);
}

}  // namespace
}  // namespace barchan::app
