// Rows by cells: the part of Rebuild after migration.
#include <algorithm>
#include <utility>

#include <barchan/core/brick/rebuild.hpp>
#include <barchan/core/particles/row_order.hpp>

namespace barchan {

/// Of the cells of the box: those of the rim first, then by keys.
template <int Dim>
std::vector<std::int32_t> Rebuild<Dim>::places_of_cells() {
  const CellBox<Dim>& box = brick_.box;
  std::vector<std::int32_t> places(static_cast<std::size_t>(box.size()));
  std::vector<char> is_rim(places.size(), 0);
  if (brick_.form == CutForm::Bricks) {
    for (const BrickLink<Dim>& link : brick_.links)
      link.sends.for_each([&](const CellAt<Dim>& at) { is_rim[box.place(at)] = 1; });
  }
  std::int32_t next = 0;
  for (const char wanted : {char{1}, char{0}}) {
    for (std::size_t c = 0; c < places.size(); ++c) {
      if (is_rim[c] == wanted) places[c] = next++;
    }
    if (wanted != 0) num_rim_cells_ = next;
  }
  return places;
}

/// Of every row that stays the place of its cell among all of the box.
template <int Dim>
std::vector<std::int32_t> Rebuild<Dim>::places_in_box() {
  const Grid<Dim>& grid = brick_.world->grid;
  const std::int64_t first_key = brick_.box.lo[0] * grid.slab_size();
  const std::vector<std::int32_t> of_cell = places_of_cells();
  std::vector<std::int32_t> places(leavers_.way.size());
  for (std::size_t row = 0; row < places.size(); ++row) {
    if (leavers_.way[row] != Leavers::Stays) continue;
    const std::int64_t key = brick_.store.key[row];
    places[row] = brick_.form == CutForm::Strips
                      ? static_cast<std::int32_t>(key - first_key)
                      : of_cell[brick_.box.place(cell_of_key(grid, key))];
  }
  num_cells_ = static_cast<std::int32_t>(of_cell.size());
  return places;
}

/// The same among the cells that have rows: of a box that is mostly empty.
template <int Dim>
std::vector<std::int32_t> Rebuild<Dim>::places_among_filled() {
  constexpr std::int64_t kInside = std::int64_t{1} << 62;  // beyond all keys
  const std::size_t num_rows = leavers_.way.size();
  std::vector<std::int64_t> rank(num_rows, 0), cells;
  std::int64_t last = -1, of_last = 0;
  for (std::size_t row = 0; row < num_rows; ++row) {
    if (leavers_.way[row] != Leavers::Stays) continue;
    if (const std::int64_t key = brick_.store.key[row]; key != last) {
      of_last = key + (is_rim(key) ? 0 : kInside);
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
  std::vector<std::int32_t> places(num_rows);
  std::int32_t place = 0;
  last = -1;
  for (std::size_t row = 0; row < num_rows; ++row) {
    if (leavers_.way[row] != Leavers::Stays) continue;
    if (rank[row] != last) place = place_of(last = rank[row]);
    places[row] = place;
  }
  num_cells_ = static_cast<std::int32_t>(cells.size());
  num_rim_cells_ = place_of(kInside);
  return places;
}

template <int Dim>
bool Rebuild<Dim>::is_rim(std::int64_t key) const {
  if (brick_.form == CutForm::Strips) return false;
  const CellAt<Dim> at = cell_of_key(brick_.world->grid, key);
  const auto is_sent = [&](const BrickLink<Dim>& link) { return link.sends.contains(at); };
  return std::any_of(brick_.links.begin(), brick_.links.end(), is_sent);
}

/// Counting sort by cell; within a cell any order will do. @return of every row where it comes
/// from, then those that have left
template <int Dim>
std::vector<std::int32_t> Rebuild<Dim>::sources() {
  const std::vector<std::int8_t>& way = leavers_.way;
  const auto stays = static_cast<std::size_t>(
      std::count(way.begin(), way.end(), static_cast<std::int8_t>(Leavers::Stays)));
  const std::vector<std::int32_t> cell =
      is_mostly_empty(brick_.box.size(), static_cast<std::int64_t>(stays)) ? places_among_filled()
                                                                           : places_in_box();
  std::vector<std::int32_t> next(static_cast<std::size_t>(num_cells_) + 1, 0);
  for (std::size_t row = 0; row < way.size(); ++row) {
    if (way[row] == Leavers::Stays) ++next[static_cast<std::size_t>(cell[row]) + 1];
  }
  for (std::size_t c = 0; c + 1 < next.size(); ++c) next[c + 1] += next[c];
  brick_.num_rim = next[static_cast<std::size_t>(num_rim_cells_)];
  std::vector<std::int32_t> source(stays);
  source.reserve(way.size());
  new_row_.assign(way.size(), -1);
  for (std::size_t row = 0; row < way.size(); ++row) {
    if (way[row] != Leavers::Stays) continue;
    new_row_[row] = next[static_cast<std::size_t>(cell[row])]++;
    source[static_cast<std::size_t>(new_row_[row])] = static_cast<std::int32_t>(row);
  }
  for (std::size_t row = 0; row < way.size(); ++row) {
    if (way[row] != Leavers::Stays) source.push_back(static_cast<std::int32_t>(row));
  }
  brick_.store.num_owned = static_cast<std::int32_t>(stays);
  return source;
}

/// @pre rows by cells
template <int Dim>
void Rebuild<Dim>::place_bands() {
  const ParticleStore<Dim>& store = brick_.store;
  const std::int32_t n = store.num_owned, rim = brick_.num_rim;
  Band &left = brick_.band(Side::Left), &right = brick_.band(Side::Right);
  if (brick_.form == CutForm::Bricks) {
    left.near = right.near = right.rows = {0, rim};
    left.rows = {0, 0};
    brick_.interior = {rim, n};
    return;
  }
  const auto first_in = [&](int slab) {
    const auto begin = store.key.begin();
    return static_cast<std::int32_t>(
        std::lower_bound(begin, begin + n, slab * brick_.world->grid.slab_size()) - begin);
  };
  left.near = left.rows = {0, left.exists ? first_in(brick_.box.lo[0] + 1) : 0};
  right.near = right.rows = {right.exists ? first_in(brick_.box.hi[0] - 1) : n, n};
  brick_.interior = {left.rows.end, std::max(left.rows.end, right.rows.begin)};
}

/// By ascending keys. Where a link sends more cells than there are rows, it goes by rows.
template <int Dim>
void Rebuild<Dim>::find_runs() {
  const Rows all{0, brick_.form == CutForm::Strips ? brick_.store.num_owned : brick_.num_rim};
  for (BrickLink<Dim>& link : brick_.links) {
    link.runs.clear();
    link.num_sent = 0;
    const auto add = [&](const CellAt<Dim>& at) {
      const Rows rows = brick_.cells.rows(at);
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
      const std::int64_t key = brick_.store.key[static_cast<std::size_t>(row)];
      if (std::exchange(last, key) == key) continue;
      const CellAt<Dim> at = cell_of_key(brick_.world->grid, key);
      if (link.sends.contains(at)) add(at);
    }
  }
}

template <int Dim>
void Rebuild<Dim>::order() {
  const World<Dim>& world = *brick_.world;
  ParticleStore<Dim>& store = brick_.store;
  constexpr auto kForce = std::size_t{Layout<Dim>::kForce};
  std::vector<std::int32_t> source = sources();
  const auto stays = static_cast<std::size_t>(store.num_owned);
  if (!store.external.empty()) store.external.resize(source.size() * kForce, 0.0);
  move_rows(store, source);
  if (!store.external.empty()) store.external.resize(stays * kForce);
  store.num_ghosts = {};
  store.resize_for_ghosts(world.grain.rounder(), world.heat.grain.rounder());
  brick_.cells.cover(world.grid, brick_.box, store.num_owned);
  brick_.cells.add(world.grid, store, {0, store.num_owned});
  place_bands();
  find_runs();
  resize_with_room(store.reference, stays * Dim);
  double* reference = store.reference.data();
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    for (int c = 0; c < Dim; ++c) *reference++ = store.x(i)[c];
  }
  brick_.skin = world.skin;
  lists_.list_bonded();
}

template class Rebuild<2>;
template class Rebuild<3>;

}  // namespace barchan
