#include <barchan/core/particles/row_order.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace barchan::test {
namespace {

template <int Dim>
void expect_rows_to_move() {
  constexpr std::int32_t kRows = 40;
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    ParticleStore<Dim> store;
    store.num_owned = kRows;
    store.resize_for_ghosts();
    store.external.assign(kRows * Layout<Dim>::kForce, 0.0);
    for (std::int32_t i = 0; i < kRows; ++i) {
      const auto at = static_cast<std::size_t>(i);
      store.id[at] = i;
      store.key[at] = 100 + i;
      store.type[at] = static_cast<std::uint8_t>(i);
      store.x(i)[0] = i + 0.25;
      store.u(i)[0] = i + 0.5;
      store.external[at * Layout<Dim>::kForce] = i + 0.75;
    }
    std::vector<std::int32_t> source(kRows);
    std::iota(source.begin(), source.end(), 0);
    std::shuffle(source.begin(), source.end() - trial, random);  // some rows may stay
    const auto wanted = source;
    move_rows(store, source);
    for (std::int32_t i = 0; i < kRows; ++i) {
      const auto at = static_cast<std::size_t>(i);
      EXPECT_EQ(store.id[at], wanted[at]);
      EXPECT_EQ(store.key[at], 100 + wanted[at]);
      EXPECT_EQ(store.type[at], wanted[at]);
      EXPECT_EQ(store.x(i)[0], wanted[at] + 0.25);
      EXPECT_EQ(store.u(i)[0], wanted[at] + 0.5);
      EXPECT_EQ(store.external[at * Layout<Dim>::kForce], wanted[at] + 0.75);
    }
  }
}

TEST(RowOrder, MovesAllThatARowHasIn2D) {
  expect_rows_to_move<2>();
}

TEST(RowOrder, MovesAllThatARowHasIn3D) {
  expect_rows_to_move<3>();
}

}  // namespace
}  // namespace barchan::test
