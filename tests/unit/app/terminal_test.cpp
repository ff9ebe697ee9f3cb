#include <barchan/app/terminal.hpp>

#include <unistd.h>

#include <cstdlib>

#include <gtest/gtest.h>

#include <barchan/app/readable.hpp>

namespace barchan::app {
namespace {

using Rows = std::vector<std::vector<std::string>>;

TEST(Terminal, HasTheColumnsThatTheEnvironmentSaysElseAHundred) {
  int ends[2] = {};
  ASSERT_EQ(::pipe(ends), 0);
  ::setenv("COLUMNS", "72", 1);
  EXPECT_EQ(columns_of(ends[1]), 72);
  ::setenv("COLUMNS", "wide", 1);
  EXPECT_EQ(columns_of(ends[1]), 100);
  ::unsetenv("COLUMNS");
  EXPECT_EQ(columns_of(ends[1]), 100);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(Terminal, LeavesOutTheLastPartsOfALineThatIsTooLong) {
  const std::vector<std::string> parts{"step 1 of 2", "0:42 left", "1 M particle-steps/s"};
  EXPECT_EQ(joined_within(parts, 80), "step 1 of 2, 0:42 left, 1 M particle-steps/s");
  EXPECT_EQ(joined_within(parts, 44), "step 1 of 2, 0:42 left, 1 M particle-steps/s");
  EXPECT_EQ(joined_within(parts, 43), "step 1 of 2, 0:42 left");
  EXPECT_EQ(joined_within(parts, 12), "step 1 of 2");
  EXPECT_EQ(joined_within({"12 µs left"}, 5), "12 µs");
}

TEST(Terminal, BreaksTextsOfATableAtSpaces) {
  const Rows rows{{"phases", "forces 50 %, search 20 %, bands 10 %, send 5 %"},
                  {"results", "a/very/long/path/without/any/space/in/it/run.json"}};

  const Rows wrapped = wrapped_within(rows, 36);

  ASSERT_EQ(wrapped.size(), 3u);
  EXPECT_EQ(wrapped[0], (std::vector<std::string>{"phases", "forces 50 %, search 20 %,"}));
  EXPECT_EQ(wrapped[1], (std::vector<std::string>{"", "bands 10 %, send 5 %"}));
  EXPECT_EQ(wrapped[2][1], rows[1][1]);
  EXPECT_EQ(wrapped_within(rows, 35)[0][1], "forces 50 %, search");  // and 20 % on the next
  const std::string text = table(wrapped, 2);
  EXPECT_LE(text.find('\n'), 36u);
}

}  // namespace
}  // namespace barchan::app
