#include <barchan/core/search/cell_box.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

namespace barchan {
namespace {

TEST(CellBox, KnowsWhichCellsTouchAnotherBox) {
  for (int periodicity = 0; periodicity < 4; ++periodicity) {
    Domain domain;
    domain.hi = Vec3(6.5, 4.5, 0.0);
    domain.periodic = {(periodicity & 1) != 0, (periodicity & 2) != 0, false};
    const Grid<2> grid(domain, 1.0);
    const CellBox<2> whole = box_of_slabs(grid, 0, grid.num_slabs());
    const CellBox<2> boxes[] = {
        {{0, 0}, {2, 4}}, {{2, 0}, {3, 2}}, {{5, 3}, {6, 4}}, {{0, 0}, {1, 1}}};
    for (const CellBox<2>& box : boxes) {
      for (const CellBox<2>& other : boxes) {
        std::set<CellAt<2>> found, expected;
        cells_beside(grid, box, other).for_each([&](const CellAt<2>& at) { found.insert(at); });
        const auto are_near = [&](const CellAt<2>& a, const CellAt<2>& b) {
          for (int k = 0; k < 2; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            const int apart = std::abs(a[axis] - b[axis]);
            if (apart > 1 && !(grid.is_periodic(k) && apart == grid.cells(k) - 1)) return false;
          }
          return true;
        };
        CellRegion<2> all{{{{{0, 5}}, {{0, 3}}}}};
        all.for_each([&](const CellAt<2>& a) {
          all.for_each([&](const CellAt<2>& b) {
            if (box.contains(a) && other.contains(b) && are_near(a, b)) expected.insert(a);
          });
        });
        EXPECT_EQ(found, expected) << "periodic " << periodicity;
        EXPECT_TRUE(whole.contains(box.lo));
      }
    }
  }
}

TEST(CellBox, WalksItsRegionsByAscendingKeys) {
  Domain domain;
  domain.hi = Vec3(6.5, 4.5, 5.5);
  const Grid<3> grid(domain, 1.0);
  const CellRegion<3> region{{{{{0, 0}, {5, 5}}, {{1, 2}}, {{0, 0}, {3, 4}}}}};

  std::int64_t last = -1;
  int count = 0;
  region.for_each([&](const CellAt<3>& at) {
    EXPECT_GT(grid.key(at), last);
    EXPECT_EQ(cell_of_key(grid, grid.key(at)), at);
    EXPECT_TRUE(region.contains(at));
    last = grid.key(at);
    ++count;
  });

  EXPECT_EQ(count, 12);
  EXPECT_EQ(region.size(), 12);
  EXPECT_FALSE(region.contains({1, 1, 0}));
}

}  // namespace
}  // namespace barchan
