#include <barchan/core/search/cell_index.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <unit/core/lane_fixture.hpp>

namespace barchan::test {
namespace {

/// Rows 0 … n−1 with the keys of random particles, ascending.
template <int Dim>
ParticleStore<Dim> keyed_store(const Grid<Dim>& grid, const Domain& domain, int count) {
  std::vector<std::int64_t> keys;
  for (const auto& p : random_particles(Dim, domain, count, 0.5, 3))
    keys.push_back(grid.key(p.position.data()));
  std::ranges::sort(keys);
  ParticleStore<Dim> store;
  store.num_owned = count;
  store.resize_for_ghosts();
  std::ranges::copy(keys, store.key.begin());
  return store;
}

TEST(CellIndex, TellsTheRowsOfEveryCell) {
  Domain domain;
  domain.hi = Vec3(5.5, 4.5, 0.0);
  const Grid<2> grid(domain, 1.0);
  const auto store = keyed_store(grid, domain, 60);
  CellIndex<2> cells;

  cells.cover(grid, box_of_slabs(grid, 0, grid.num_slabs()), 60);
  cells.add(grid, store, {0, 60});

  for (std::int64_t key = 0; key < grid.num_slabs() * grid.slab_size(); ++key) {
    const Rows rows = cells.rows(cell_of_key(grid, key));
    EXPECT_EQ(rows.end - rows.begin, std::count(store.key.begin(), store.key.begin() + 60, key));
    for (std::int32_t i = rows.begin; i < rows.end; ++i)
      EXPECT_EQ(store.key[static_cast<std::size_t>(i)], key);
  }
}

TEST(CellIndex, KeepsTheFilledCellsOfAMostlyEmptyBox) {
  Domain domain;
  domain.hi = Vec3(3000.0, 2000.0, 1000.0);
  const Grid<3> grid(domain, 1.0);
  Domain filled;
  filled.hi = Vec3(40.0, 30.0, 20.0);
  const auto store = keyed_store(grid, filled, 2000);
  CellIndex<3> cells;

  cells.cover(grid, box_of_slabs(grid, 0, grid.num_slabs()), 100);  // the rest like ghosts
  cells.add(grid, store, {0, 700});
  cells.add(grid, store, {700, 2000});

  EXPECT_LT(cells.bytes(), 2000 * 200);
  CellAt<3> at{};
  std::int64_t found = 0;
  for (at[0] = 0; at[0] < 45; ++at[0]) {
    for (at[1] = 0; at[1] < 35; ++at[1]) {
      for (at[2] = 0; at[2] < 25; ++at[2]) {
        const Rows rows = cells.rows(at);
        found += rows.size();
        const auto key = grid.key(at);
        for (std::int32_t i = rows.begin; i < rows.end; ++i)
          EXPECT_EQ(store.key[static_cast<std::size_t>(i)], key);
      }
    }
  }
  EXPECT_EQ(found, 2000);
}

/// Keys of the 3^Dim cells around a cell, from coordinates.
template <int Dim>
std::set<std::int64_t> cells_around(const Grid<Dim>& grid, std::int64_t key) {
  int at[3] = {};
  for (int k = Dim - 1; k >= 0; --k) {
    at[k] = static_cast<int>(key % grid.cells(k));
    key /= grid.cells(k);
  }
  std::set<std::int64_t> keys;
  for (int n = 0; n < (Dim == 2 ? 9 : 27); ++n) {
    std::int64_t other = 0;
    bool exists = true;
    for (int k = 0, rest = n; k < Dim; ++k, rest /= 3) {
      int c = at[k] + rest % 3 - 1;
      if (grid.is_periodic(k)) c = (c + grid.cells(k)) % grid.cells(k);
      exists = exists && c >= 0 && c < grid.cells(k);
      other = other * grid.cells(k) + c;
    }
    if (exists) keys.insert(other);
  }
  return keys;
}

template <int Dim>
void expect_neighbourhoods(const Domain& domain) {
  const Grid<Dim> grid(domain, 1.0);
  const auto store = keyed_store(grid, domain, 300);
  CellIndex<Dim> cells;
  cells.cover(grid, box_of_slabs(grid, 0, grid.num_slabs()), 300);
  cells.add(grid, store, {0, 300});
  Neighbourhood<Dim> around;
  for (std::int64_t key = 0; key < grid.num_slabs() * grid.slab_size(); ++key) {
    for (const Rows wanted : {Rows{0, 300}, Rows{120, 300}, Rows{40, 90}}) {
      around.collect(cells, cell_of_key(grid, key), wanted);

      std::vector<std::int32_t> found, expected;
      for (int q = 0; q < around.count; ++q) {
        const Rows rows = around.ranges[static_cast<std::size_t>(q)];
        for (std::int32_t i = rows.begin; i < rows.end; ++i) found.push_back(i);
      }
      const auto keys = cells_around(grid, key);
      for (std::int32_t i = wanted.begin; i < wanted.end; ++i) {
        if (keys.contains(store.key[static_cast<std::size_t>(i)])) expected.push_back(i);
      }
      ASSERT_EQ(found, expected) << "cell " << key << ", rows from " << wanted.begin;
    }
  }
}

TEST(Neighbourhood, HasTheRowsOfAllCellsAroundInOrderAndOnce) {
  const double lengths[] = {1.5, 2.5, 3.5, 5.5};
  for (int shape = 0; shape < 64; ++shape) {
    for (int periodicity = 0; periodicity < 8; ++periodicity) {
      Domain domain;
      bool is_possible = true;
      for (int a = 0; a < 3; ++a) {
        domain.hi[a] = lengths[(shape >> (2 * a)) & 3];
        domain.periodic[static_cast<std::size_t>(a)] = ((periodicity >> a) & 1) != 0;
        is_possible =
            is_possible && !(domain.periodic[static_cast<std::size_t>(a)] && domain.hi[a] < 2.0);
      }
      if (!is_possible) continue;
      expect_neighbourhoods<3>(domain);
      if (shape < 16 && periodicity < 4) expect_neighbourhoods<2>(domain);
    }
  }
}

}  // namespace
}  // namespace barchan::test
