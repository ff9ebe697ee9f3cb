#include <barchan/core/search/cell_index.hpp>

#include <algorithm>

namespace barchan {

template <int Dim>
void CellIndex::index(const Grid<Dim>& grid, const ParticleStore<Dim>& store, Rows rows,
                      int from_slab, int to_slab) {
  slab_begin = from_slab;
  slab_end = to_slab;
  first_key = from_slab * grid.slab_size();
  const auto num_cells = static_cast<std::size_t>((to_slab - from_slab) * grid.slab_size());
  start.resize(num_cells + 1);
  std::size_t cell = 0;
  for (std::int32_t row = rows.begin; row < rows.end; ++row) {
    const auto own = static_cast<std::size_t>(store.key[static_cast<std::size_t>(row)] - first_key);
    while (cell <= own) start[cell++] = row;
  }
  while (cell <= num_cells) start[cell++] = rows.end;
}

template <int Dim>
void Neighbourhood<Dim>::collect(const Grid<Dim>& grid, const CellIndex& index, std::int64_t key,
                                 int first_offset, int last_offset, std::int64_t after_key) {
  const int nz = grid.cells(Dim - 1);
  const std::int64_t line = key / nz;
  if (line != line_ || &index != index_) find_lines(grid, index, line, first_offset, last_offset);
  count = 0;
  sorted_ = true;
  wraps = is_narrow_;
  const int z = static_cast<int>(key - line * nz);
  for (int l = 0; l < num_lines_; ++l)
    add_line(grid, index, lines_[static_cast<std::size_t>(l)], z, after_key);
  finish();
}

template <int Dim>
void Neighbourhood<Dim>::find_lines(const Grid<Dim>& grid, const CellIndex& index,
                                    std::int64_t line, int first_offset, int last_offset) {
  line_ = line;
  index_ = &index;
  num_lines_ = 0;
  // Where there are four or more, nearest images of particles in cells side by side are themselves.
  is_narrow_ = false;
  for (int k = 0; k < Dim; ++k)
    is_narrow_ = is_narrow_ || (grid.is_periodic(k) && grid.cells(k) < 4);
  const int n0 = grid.cells(0), nz = grid.cells(Dim - 1), ny = Dim == 3 ? grid.cells(1) : 1;
  const int y = static_cast<int>(line % ny), x = static_cast<int>(line / ny);
  const int dy_max = Dim == 3 ? 1 : 0;
  for (int dx = first_offset; dx <= last_offset; ++dx) {
    const int slab = grid.is_periodic(0) ? (x + dx + n0) % n0 : x + dx;
    if (slab < 0 || slab >= n0 || !index.has_slab(slab)) continue;
    for (int dy = -dy_max; dy <= dy_max; ++dy) {
      const int row = Dim == 3 && grid.is_periodic(1) ? (y + dy + ny) % ny : y + dy;
      if (row < 0 || row >= ny) continue;
      lines_[static_cast<std::size_t>(num_lines_++)] = {
          (static_cast<std::int64_t>(slab) * ny + row) * nz, slab != x + dx || row != y + dy};
    }
  }
}

template <int Dim>
void Neighbourhood<Dim>::add_line(const Grid<Dim>& grid, const CellIndex& index, const Line& line,
                                  int z, std::int64_t after_key) {
  const int nz = grid.cells(Dim - 1);
  const auto clip = [&](int from, int to) {
    const std::int64_t begin = std::max(line.key + from, after_key + 1), end = line.key + to;
    if (begin >= end) return;
    wraps = wraps || line.wraps;
    add(index.cells(begin, end));
  };
  if (grid.is_periodic(Dim - 1) && (z == 0 || z == nz - 1)) {
    wraps = true;
    if (nz <= 3) return clip(0, nz);
    if (z == 0) {
      clip(0, 2);
      return clip(nz - 1, nz);
    }
    clip(0, 1);
    return clip(nz - 2, nz);
  }
  clip(std::max(0, z - 1), std::min(nz, z + 2));
}

template <int Dim>
void Neighbourhood<Dim>::add(Rows rows) {
  if (rows.begin == rows.end) return;
  if (count > 0 && rows.begin < ranges[static_cast<std::size_t>(count - 1)].end) sorted_ = false;
  ranges[static_cast<std::size_t>(count++)] = rows;
}

template <int Dim>
void Neighbourhood<Dim>::finish() {
  if (sorted_) return;
  auto* const first = ranges.data();
  std::sort(first, first + count, [](const Rows& a, const Rows& b) { return a.begin < b.begin; });
  // An axis of one or two periodic cells is met twice.
  int kept = 0;
  for (int q = 0; q < count; ++q) {
    if (kept == 0 || ranges[static_cast<std::size_t>(q)].begin >=
                         ranges[static_cast<std::size_t>(kept - 1)].end) {
      ranges[static_cast<std::size_t>(kept++)] = ranges[static_cast<std::size_t>(q)];
    }
  }
  count = kept;
}

template void CellIndex::index(const Grid<2>&, const ParticleStore<2>&, Rows, int, int);
template void CellIndex::index(const Grid<3>&, const ParticleStore<3>&, Rows, int, int);
template struct Neighbourhood<2>;
template struct Neighbourhood<3>;

}  // namespace barchan
