#include <barchan/core/brick/passage.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace barchan {
namespace {

Passage passage(std::int64_t first, std::int64_t second, std::int32_t wall = -1) {
  Passage p;
  p.first.id = first;
  p.second.id = second;
  p.wall = wall;
  return p;
}

TEST(Passage, OfAllInAStepThatWithTheLowestIdsIsKeptInAnyOrder) {
  std::vector<Passage> all{passage(2, 9),    passage(2, 5),    passage(3, 4),
                           passage(2, 0, 1), passage(2, 0, 0), Passage{}};
  const auto is_less = [](const Passage& a, const Passage& b) {
    return a.second.id != b.second.id ? a.second.id < b.second.id : a.wall < b.wall;
  };
  std::sort(all.begin(), all.end(), is_less);
  do {
    Passage kept;
    for (const Passage& p : all) kept.add(p);

    EXPECT_EQ(kept.first.id, 2);
    EXPECT_EQ(kept.second.id, 0);
    EXPECT_EQ(kept.wall, 0);
  } while (std::next_permutation(all.begin(), all.end(), is_less));
}

}  // namespace
}  // namespace barchan
