#include <barchan/core/search/cell_box.hpp>

namespace barchan {

template <int Dim>
CellRegion<Dim> cells_beside(const Grid<Dim>& grid, const CellBox<Dim>& box,
                             const CellBox<Dim>& other) {
  CellRegion<Dim> region;
  for (int axis = 0; axis < Dim; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    const int n = grid.is_periodic(axis) ? grid.cells(axis) : 0;
    auto& spans = region.spans[k];
    for (const int around : {-n, 0, n}) {  // images of the other box, ascending
      const CellSpan span{std::max(box.lo[k], other.lo[k] - 1 + around),
                          std::min(box.hi[k] - 1, other.hi[k] + around)};
      if (span.first > span.last) continue;
      if (!spans.empty() && span.first <= spans.back().last + 1)
        spans.back().last = std::max(spans.back().last, span.last);
      else
        spans.push_back(span);
    }
  }
  return region;
}

template CellRegion<2> cells_beside(const Grid<2>&, const CellBox<2>&, const CellBox<2>&);
template CellRegion<3> cells_beside(const Grid<3>&, const CellBox<3>&, const CellBox<3>&);

}  // namespace barchan
