#include <barchan/core/search/cell_box.hpp>

namespace barchan {

template <int Dim>
CellRegion<Dim> cells_beside(const Grid<Dim>& grid, const CellBox<Dim>& box,
                             const CellBox<Dim>& other) {
  CellRegion<Dim> region;
  for (int axis = 0; axis < Dim; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    const int n = grid.cells(axis);
    const auto touches = [&](int c) {
      const auto is_near = [&](int at) { return at >= other.lo[k] - 1 && at <= other.hi[k]; };
      return is_near(c) || (grid.is_periodic(axis) && (is_near(c - n) || is_near(c + n)));
    };
    for (int c = box.lo[k]; c < box.hi[k]; ++c) {
      if (touches(c)) region.lists[k].push_back(c);
    }
  }
  return region;
}

template CellRegion<2> cells_beside(const Grid<2>&, const CellBox<2>&, const CellBox<2>&);
template CellRegion<3> cells_beside(const Grid<3>&, const CellBox<3>&, const CellBox<3>&);

}  // namespace barchan
