#include <barchan/comm/topology/strips.hpp>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

using Counts = std::vector<std::int64_t>;

void expect_valid(const std::vector<int>& cuts, int num_slabs, int num_strips, int min_slabs) {
  ASSERT_EQ(cuts.size(), static_cast<std::size_t>(num_strips) + 1);
  EXPECT_EQ(cuts.front(), 0);
  EXPECT_EQ(cuts.back(), num_slabs);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) EXPECT_GE(cuts[i + 1] - cuts[i], min_slabs);
}

Counts random_counts(std::mt19937& random, int num_slabs) {
  Counts counts(static_cast<std::size_t>(num_slabs));
  for (auto& count : counts)
    count = random() % 3 == 0 ? 0 : static_cast<std::int64_t>(random() % 1000);
  return counts;
}

TEST(Strips, CutsEqualCountsIntoEqualWidths) {
  EXPECT_EQ(cut_equal(Counts(12, 5), 3, 2), (std::vector{0, 4, 8, 12}));
}

TEST(Strips, CutsAnEmptyDomainIntoEqualWidths) {
  EXPECT_EQ(cut_equal(Counts(12, 0), 4, 2), (std::vector{0, 3, 6, 9, 12}));
}

TEST(Strips, KeepsEveryStripWideEnoughWhereverTheParticlesAre) {
  std::mt19937 random(1);

  for (int trial = 0; trial < 2000; ++trial) {
    const int min_slabs = 1 + static_cast<int>(random() % 3);
    const int num_strips = 1 + static_cast<int>(random() % 6);
    const int num_slabs = num_strips * min_slabs + static_cast<int>(random() % 20);
    expect_valid(cut_equal(random_counts(random, num_slabs), num_strips, min_slabs), num_slabs,
                 num_strips, min_slabs);
  }
}

TEST(Strips, ComesNearTheMeanWhenSlabsAreMany) {
  std::mt19937 random(2);
  const Counts counts = random_counts(random, 1000);

  EXPECT_LT(imbalance(cut_equal(counts, 7, 2), counts), 1.03);
}

TEST(Strips, SaysHowManyFit) {
  EXPECT_EQ(max_strips(11, 2), 5);
  EXPECT_EQ(max_strips(1, 2), 1);
  try {
    static_cast<void>(cut_equal(Counts(11, 5), 6, 2));
    FAIL() << "six strips of two slabs were cut from eleven";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("at most 5 ranks"), std::string::npos) << error.what();
  }
}

TEST(Strips, GivesALoneStripEverything) {
  EXPECT_EQ(cut_equal(Counts(1, 9), 1, 2), (std::vector{0, 1}));
}

TEST(Strips, LeavesTheCutsWhileTheLargestIsNearTheMean) {
  const Counts counts{100, 100, 105, 100, 100, 100};
  const std::vector cuts{0, 3, 6};

  EXPECT_EQ(recut(cuts, counts, 2, 2), cuts);
}

TEST(Strips, NeverMovesACutToItsNeighbours) {
  std::mt19937 random(3);

  for (int trial = 0; trial < 2000; ++trial) {
    const int min_slabs = 1 + static_cast<int>(random() % 3);
    const int num_strips = 1 + static_cast<int>(random() % 6);
    const int num_slabs = num_strips * min_slabs + static_cast<int>(random() % 30);
    const auto old_cuts = cut_equal(random_counts(random, num_slabs), num_strips, min_slabs);
    const Counts counts = random_counts(random, num_slabs);

    const auto cuts = recut(old_cuts, counts, num_strips, min_slabs);

    expect_valid(cuts, num_slabs, num_strips, min_slabs);
    EXPECT_LE(imbalance(cuts, counts), imbalance(old_cuts, counts));
    for (int i = 1; i < num_strips; ++i) {
      EXPECT_GT(cuts[static_cast<std::size_t>(i)], old_cuts[static_cast<std::size_t>(i) - 1]);
      EXPECT_LT(cuts[static_cast<std::size_t>(i)], old_cuts[static_cast<std::size_t>(i) + 1]);
    }
    for (int slab = 0; slab < num_slabs;
         ++slab) {  // a particle may have strayed by one slab before it is handed over
      for (const int before : {std::max(0, slab - 1), slab, std::min(num_slabs - 1, slab + 1)}) {
        EXPECT_LE(std::abs(strip_of(cuts, slab) - strip_of(old_cuts, before)), 1);
      }
    }
  }
}

TEST(Strips, ReachesBalanceInAFewCalls) {
  Counts counts(200, 0);
  for (std::size_t slab = 150; slab < 200; ++slab) counts[slab] = 10;
  auto cuts = cut_equal(Counts(200, 1), 5, 2);

  for (int call = 0; call < 12; ++call) cuts = recut(cuts, counts, 5, 2);

  EXPECT_LE(imbalance(cuts, counts), 1.03);
}

TEST(Strips, FindsTheOwnerOfASlab) {
  const std::vector cuts{0, 3, 6, 10};

  EXPECT_EQ(strip_of(cuts, 0), 0);
  EXPECT_EQ(strip_of(cuts, 2), 0);
  EXPECT_EQ(strip_of(cuts, 3), 1);
  EXPECT_EQ(strip_of(cuts, 9), 2);
}

}  // namespace
}  // namespace barchan
