#include <barchan/core/brick/cell_order.hpp>

#include <algorithm>
#include <utility>

#include <barchan/core/brick/history_carry.hpp>

namespace barchan {
namespace {

/// Where the cell of every row that stays stands among all cells in that order.
struct Places {
  std::vector<std::int32_t> of_row;
  std::int32_t num_cells = 0, num_rim = 0;  ///< the cells of the rim come first
};

/// By cell of the box its place. @param num_rim  replaced: cells of the rim
template <int Dim>
std::vector<std::int32_t> rim_first(const Brick<Dim>& brick, std::int32_t& num_rim) {
  const auto num_cells = static_cast<std::size_t>(brick.box.size());
  std::vector<char> is_rim(num_cells, 0);
  for (const BrickLink<Dim>& link : brick.links)
    link.sends.for_each([&](const CellAt<Dim>& at) { is_rim[brick.box.place(at)] = 1; });
  num_rim = static_cast<std::int32_t>(std::count(is_rim.begin(), is_rim.end(), char{1}));
  std::vector<std::int32_t> places(num_cells);
  std::int32_t rim = 0, inside = num_rim;
  for (std::size_t c = 0; c < num_cells; ++c) places[c] = is_rim[c] != 0 ? rim++ : inside++;
  return places;
}

/// Among all cells of the box.
template <int Dim>
Places places_in_box(const Brick<Dim>& brick, std::span<const std::int8_t> way) {
  const CellBox<Dim>& box = brick.box;
  const Grid<Dim>& grid = brick.world->grid;
  Places places{std::vector<std::int32_t>(way.size()), static_cast<std::int32_t>(box.size()), 0};
  const std::vector<std::int32_t> of_cell = brick.form == CutForm::Bricks
                                                ? rim_first(brick, places.num_rim)
                                                : std::vector<std::int32_t>{};
  const std::int64_t first_key = box.lo[0] * grid.slab_size();
  for (std::size_t row = 0; row < way.size(); ++row) {
    if (way[row] != Leavers::Stays) continue;
    const std::int64_t key = brick.store.key[row];
    places.of_row[row] = brick.form == CutForm::Strips ? static_cast<std::int32_t>(key - first_key)
                                                       : of_cell[box.place(cell_of_key(grid, key))];
  }
  return places;
}

template <int Dim>
bool is_rim(const Brick<Dim>& brick, std::int64_t key) {
  if (brick.form == CutForm::Strips) return false;
  const CellAt<Dim> at = cell_of_key(brick.world->grid, key);
  const auto is_sent = [&](const BrickLink<Dim>& link) { return link.sends.contains(at); };
  return std::any_of(brick.links.begin(), brick.links.end(), is_sent);
}

/// Among the cells that have rows: of a box that is mostly empty.
template <int Dim>
Places places_among_filled(const Brick<Dim>& brick, std::span<const std::int8_t> way) {
  constexpr std::int64_t kInside = std::int64_t{1} << 62;  // beyond all keys
  std::vector<std::int64_t> rank(way.size(), 0), cells;
  std::int64_t last = -1, of_last = 0;
  for (std::size_t row = 0; row < way.size(); ++row) {
    if (way[row] != Leavers::Stays) continue;
    if (const std::int64_t key = brick.store.key[row]; key != last) {
      of_last = key + (is_rim(brick, key) ? 0 : kInside);
      cells.push_back(of_last);
      last = key;
    }
    rank[row] = of_last;
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  const auto place_of = [&](std::int64_t its) {
    return static_cast<std::int32_t>(std::lower_bound(cells.begin(), cells.end(), its) -
                                     cells.begin());
  };
  Places places{std::vector<std::int32_t>(way.size()), static_cast<std::int32_t>(cells.size()),
                place_of(kInside)};
  std::int32_t place = 0;
  last = -1;
  for (std::size_t row = 0; row < way.size(); ++row) {
    if (way[row] != Leavers::Stays) continue;
    if (std::exchange(last, rank[row]) != rank[row]) place = place_of(rank[row]);
    places.of_row[row] = place;
  }
  return places;
}

/// The first row in a slab, or beyond it. @pre strips
template <int Dim>
std::int32_t first_in_slab(const Brick<Dim>& brick, int slab) {
  const auto begin = brick.store.key.begin();
  return static_cast<std::int32_t>(
      std::lower_bound(begin, begin + brick.store.num_owned, slab * brick.world->grid.slab_size()) -
      begin);
}

}  // namespace

/// Counting sort.
template <int Dim>
CellOrder order_by_cells(const Brick<Dim>& brick, std::span<const std::int8_t> way) {
  const auto stays =
      static_cast<std::int32_t>(std::count(way.begin(), way.end(), std::int8_t{Leavers::Stays}));
  const Places places = is_mostly_empty(brick.box.size(), stays) ? places_among_filled(brick, way)
                                                                 : places_in_box(brick, way);
  std::vector<std::int32_t> next(static_cast<std::size_t>(places.num_cells) + 1, 0);
  for (std::size_t row = 0; row < way.size(); ++row) {
    if (way[row] == Leavers::Stays) ++next[static_cast<std::size_t>(places.of_row[row]) + 1];
  }
  for (std::size_t c = 0; c + 1 < next.size(); ++c) next[c + 1] += next[c];
  CellOrder order;
  order.num_owned = stays;
  order.num_rim = next[static_cast<std::size_t>(places.num_rim)];
  order.source.reserve(way.size());
  order.source.resize(static_cast<std::size_t>(stays));
  order.new_row.assign(way.size(), -1);
  for (std::size_t row = 0; row < way.size(); ++row) {
    const auto source = static_cast<std::int32_t>(row);
    if (way[row] != Leavers::Stays) {
      order.source.push_back(source);
      continue;
    }
    order.new_row[row] = next[static_cast<std::size_t>(places.of_row[row])]++;
    order.source[static_cast<std::size_t>(order.new_row[row])] = source;
  }
  return order;
}

template <int Dim>
void place_bands(Brick<Dim>& brick) {
  const ParticleStore<Dim>& store = brick.store;
  const std::int32_t n = store.num_owned, rim = brick.num_rim;
  Band &left = brick.band(Side::Left), &right = brick.band(Side::Right);
  if (brick.form == CutForm::Bricks) {
    left.near = right.near = right.rows = {0, rim};
    left.rows = {0, 0};
    brick.interior = {rim, n};
    return;
  }
  left.near = left.rows = {0, left.exists ? first_in_slab(brick, brick.box.lo[0] + 1) : 0};
  right.near = right.rows = {right.exists ? first_in_slab(brick, brick.box.hi[0] - 1) : n, n};
  brick.interior = {left.rows.end, std::max(left.rows.end, right.rows.begin)};
}

template <int Dim>
Rows slab_behind(const Brick<Dim>& brick, Side side, int number) {
  const int slab = side == Side::Left ? brick.box.lo[0] + number : brick.box.hi[0] - 1 - number;
  return {first_in_slab(brick, slab), first_in_slab(brick, slab + 1)};
}

/// Where a link sends more cells than there are rows, it goes by rows.
template <int Dim>
void find_runs(Brick<Dim>& brick) {
  const Rows all{0, brick.form == CutForm::Strips ? brick.store.num_owned : brick.num_rim};
  for (BrickLink<Dim>& link : brick.links) {
    link.runs.clear();
    link.num_sent = 0;
    const auto add = [&](const CellAt<Dim>& at) {
      const Rows rows = brick.cells.rows(at);
      if (rows.begin == rows.end) return;
      link.num_sent += rows.end - rows.begin;
      if (!link.runs.empty() && link.runs.back().end == rows.begin)
        link.runs.back().end = rows.end;
      else
        link.runs.push_back(rows);
    };
    if (link.sends.size() <= all.size()) {
      link.sends.for_each(add);
      continue;
    }
    std::int64_t last = -1;
    for (std::int32_t row = all.begin; row < all.end; ++row) {
      const std::int64_t key = brick.store.key[static_cast<std::size_t>(row)];
      if (std::exchange(last, key) == key) continue;
      const CellAt<Dim> at = cell_of_key(brick.world->grid, key);
      if (link.sends.contains(at)) add(at);
    }
  }
}

template CellOrder order_by_cells(const Brick<2>&, std::span<const std::int8_t>);
template CellOrder order_by_cells(const Brick<3>&, std::span<const std::int8_t>);
template void place_bands(Brick<2>&);
template void place_bands(Brick<3>&);
template Rows slab_behind(const Brick<2>&, Side, int);
template Rows slab_behind(const Brick<3>&, Side, int);
template void find_runs(Brick<2>&);
template void find_runs(Brick<3>&);

}  // namespace barchan
