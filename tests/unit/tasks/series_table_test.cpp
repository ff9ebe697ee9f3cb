#include <barchan/tasks/results/series_table.hpp>

#include <set>

#include <gtest/gtest.h>

namespace barchan {
namespace {

std::vector<WallSpec> walls_named(const std::vector<std::string>& names) {
  std::vector<WallSpec> walls(names.size());
  for (std::size_t w = 0; w < names.size(); ++w) walls[w].name = names[w];
  return walls;
}

TEST(WallColumns, AreTheNamesWhereTheseAreColumns) {
  EXPECT_EQ(wall_columns(walls_named({"floor", "left-wall", "p_2"})),
            (std::vector<std::string>{"floor", "left-wall", "p_2"}));
}

TEST(WallColumns, DifferWhereNamesBecomeTheSame) {
  EXPECT_EQ(wall_columns(walls_named({"a b", "a.b", "a_b", "a_b_2"})),
            (std::vector<std::string>{"a_b_3", "a_b_4", "a_b", "a_b_2"}));
}

TEST(WallColumns, DifferForNamesWithoutALetterOfTheAlphabet) {
  const auto columns = wall_columns(walls_named({"пол", "дно", "床", "___", "______"}));

  EXPECT_EQ(std::set<std::string>(columns.begin(), columns.end()).size(), 5u);
}

}  // namespace
}  // namespace barchan
