#include <barchan/core/search/cell_index.hpp>

#include <algorithm>

namespace barchan {
namespace {

/// Of a periodic axis with fewer cells two are beside each other both ways: nearest images of
/// particles in cells side by side may be others than themselves.
constexpr int kFewestWithoutImages = 4;

}  // namespace

template <int Dim>
void CellIndex<Dim>::cover(const Grid<Dim>& grid, const CellBox<Dim>& box, std::int64_t num_rows) {
  std::int64_t num_cells = 1;
  for (int axis = 0; axis < Dim; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    Axis& a = axes_[k];
    a.cells = grid.cells(axis);
    a.is_ring = grid.is_periodic(axis);
    const bool is_cut = box.length(axis) < a.cells;
    int first = box.lo[k] - (is_cut ? 1 : 0), end = box.hi[k] + (is_cut ? 1 : 0);
    if (!a.is_ring) first = std::max(first, 0), end = std::min(end, a.cells);
    a.wraps = a.is_ring && end - first >= a.cells;
    a.length = std::min(end - first, a.cells);
    a.first = a.wraps ? 0 : (first + a.cells) % a.cells;
    num_cells *= a.length;
  }
  rows_.begin(num_cells, num_rows);
}

template <int Dim>
void CellIndex<Dim>::add(const Grid<Dim>& grid, const ParticleStore<Dim>& store, Rows rows) {
  std::int64_t last_key = -1;
  Rows* cell = nullptr;
  for (std::int32_t row = rows.begin; row < rows.end; ++row) {
    const std::int64_t key = store.key[static_cast<std::size_t>(row)];
    if (key != last_key) {
      cell = &rows_.make(place(cell_of_key(grid, key)));
      *cell = {row, row};
      last_key = key;
    }
    cell->end = row + 1;
  }
}

template <int Dim>
auto Neighbourhood<Dim>::steps(const typename CellIndex<Dim>::Axis& axis, int c) -> Steps {
  Steps found;
  const int own = axis.local(c);
  for (int l = own - 1; l <= own + 1; ++l) {
    const bool is_inside = l >= 0 && l < axis.length;
    if (!is_inside && !axis.wraps) continue;
    const int local = is_inside ? l : (l + axis.length) % axis.length;
    const auto end = found.local.begin() + found.count;
    if (std::find(found.local.begin(), end, local) != end) continue;  // an axis of one or two cells
    found.local[static_cast<std::size_t>(found.count++)] = local;
  }
  // Around the end of the box or not, seen from the cell.
  const bool is_at_end = c == 0 || c == axis.cells - 1;
  wraps = wraps || (axis.is_ring && (is_at_end || axis.cells < kFewestWithoutImages));
  return found;
}

template <int Dim>
void Neighbourhood<Dim>::collect(const CellIndex<Dim>& index, const CellAt<Dim>& at, Rows wanted) {
  count = 0;
  wraps = false;
  std::array<Steps, Dim> around;
  for (std::size_t k = 0; k < Dim; ++k) around[k] = steps(index.axes_[k], at[k]);
  const auto add_line = [&](std::int64_t line) {
    line *= index.axes_[Dim - 1].length;
    for (int z = 0; z < around[Dim - 1].count; ++z)
      add(index.rows_.of(line + around[Dim - 1].local[static_cast<std::size_t>(z)]), wanted);
  };
  for (int x = 0; x < around[0].count; ++x) {
    const std::int64_t slab = around[0].local[static_cast<std::size_t>(x)];
    if constexpr (Dim == 2) {
      add_line(slab);
    } else {
      for (int y = 0; y < around[1].count; ++y)
        add_line(slab * index.axes_[1].length + around[1].local[static_cast<std::size_t>(y)]);
    }
  }
  const auto by_begin = [](const Rows& a, const Rows& b) { return a.begin < b.begin; };
  if (!std::is_sorted(ranges.begin(), ranges.begin() + count, by_begin))
    std::sort(ranges.begin(), ranges.begin() + count, by_begin);
}

template <int Dim>
void Neighbourhood<Dim>::add(Rows rows, Rows wanted) {
  rows = {std::max(rows.begin, wanted.begin), std::min(rows.end, wanted.end)};
  if (rows.begin >= rows.end) return;
  if (count > 0 && ranges[static_cast<std::size_t>(count - 1)].end == rows.begin)
    ranges[static_cast<std::size_t>(count - 1)].end = rows.end;
  else
    ranges[static_cast<std::size_t>(count++)] = rows;
}

template class CellIndex<2>;
template class CellIndex<3>;
template class Neighbourhood<2>;
template class Neighbourhood<3>;

}  // namespace barchan
