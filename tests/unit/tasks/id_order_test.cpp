#include <barchan/tasks/id_order.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace barchan {
namespace {

std::vector<std::int64_t> in_order(const std::vector<std::int64_t>& ids) {
  std::vector<std::int64_t> ordered;
  for (const std::size_t k : order_of(ids)) ordered.push_back(ids[k]);
  return ordered;
}

TEST(IdOrder, IsAscendingWithGapsAndWithout) {
  EXPECT_TRUE(in_order({}).empty());
  EXPECT_EQ(in_order({3, 1, 2}), (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_EQ(in_order({9, 2, 5}), (std::vector<std::int64_t>{2, 5, 9}));
  const std::int64_t far = std::int64_t{1} << 62;
  EXPECT_EQ(in_order({far, 7, far - 1}), (std::vector<std::int64_t>{7, far - 1, far}));
}

TEST(IdOrder, FindsTwins) {
  for (const std::vector<std::int64_t>& ids :
       {std::vector<std::int64_t>{}, {5}, {1, 2, 9}, {9, 1, 2}})
    EXPECT_EQ(twin_among(ids), 0);
  EXPECT_EQ(twin_among(std::vector<std::int64_t>{1, 4, 4}), 4);
  EXPECT_EQ(twin_among(std::vector<std::int64_t>{4, 1, 4}), 4);
}

}  // namespace
}  // namespace barchan
