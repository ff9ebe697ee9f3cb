#include <barchan/core/cell_index.hpp>

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
  count = 0;
  sorted_ = true;
  const int n0 = grid.cells(0), nz = grid.cells(Dim - 1), ny = Dim == 3 ? grid.cells(1) : 1;
  const int z = static_cast<int>(key % nz);
  const int y = Dim == 3 ? static_cast<int>(key / nz % ny) : 0;
  const int x = static_cast<int>(key / grid.slab_size());
  const int dy_max = Dim == 3 ? 1 : 0;
  for (int dx = first_offset; dx <= last_offset; ++dx) {
    int slab = x + dx;
    if (slab < 0 || slab >= n0) {
      if (!grid.is_periodic(0)) continue;
      slab = (slab + n0) % n0;
    }
    if (!index.has_slab(slab)) continue;
    for (int dy = -dy_max; dy <= dy_max; ++dy) {
      int row = y + dy;
      if (Dim == 3 && (row < 0 || row >= ny)) {
        if (!grid.is_periodic(1)) continue;
        row = (row + ny) % ny;
      }
      add_line(grid, index, (static_cast<std::int64_t>(slab) * ny + row) * nz, z, after_key);
    }
  }
  finish();
}

template <int Dim>
void Neighbourhood<Dim>::add_line(const Grid<Dim>& grid, const CellIndex& index, std::int64_t line,
                                  int z, std::int64_t after_key) {
  const int nz = grid.cells(Dim - 1);
  const auto clip = [&](int from, int to) {
    const std::int64_t begin = std::max(line + from, after_key + 1), end = line + to;
    if (begin < end) add(index.cells(begin, end));
  };
  if (grid.is_periodic(Dim - 1) && (z == 0 || z == nz - 1)) {
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
