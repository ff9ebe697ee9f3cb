// Rows by cells: the part of Rebuild after migration.
#include <algorithm>

#include <barchan/core/brick/rebuild.hpp>
#include <barchan/core/particles/row_order.hpp>

namespace barchan {

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

/// Counting sort by cell; within a cell any order will do. @return of every row where it comes
/// from, then those that have left
template <int Dim>
std::vector<std::int32_t> Rebuild<Dim>::sources() {
  const std::vector<std::int8_t>& way = leavers_.way;
  const std::vector<std::int32_t> places = places_of_cells();
  const Grid<Dim>& grid = brick_.world->grid;
  const std::int64_t first_key = brick_.box.lo[0] * grid.slab_size();
  const auto place_of_row = [&](std::size_t row) {
    const std::int64_t key = brick_.store.key[row];
    if (brick_.form == CutForm::Strips) return static_cast<std::int32_t>(key - first_key);
    return places[brick_.box.place(cell_of_key(grid, key))];
  };
  std::vector<std::int32_t> next(places.size() + 1, 0), cell(way.size());
  std::int32_t stays = 0;
  for (std::size_t row = 0; row < way.size(); ++row) {
    if (way[row] != Leavers::Stays) continue;
    cell[row] = place_of_row(row);
    ++next[static_cast<std::size_t>(cell[row]) + 1];
    ++stays;
  }
  for (std::size_t c = 0; c + 1 < next.size(); ++c) next[c + 1] += next[c];
  brick_.num_rim = next[static_cast<std::size_t>(num_rim_cells_)];
  std::vector<std::int32_t> source(static_cast<std::size_t>(stays));
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
  brick_.store.num_owned = stays;
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

template <int Dim>
void Rebuild<Dim>::find_runs() {
  for (BrickLink<Dim>& link : brick_.links) {
    link.runs.clear();
    link.num_sent = 0;
    link.sends.for_each([&](const CellAt<Dim>& at) {
      const Rows rows = brick_.cells.rows(at);
      if (rows.begin == rows.end) return;
      link.num_sent += rows.end - rows.begin;
      if (!link.runs.empty() && link.runs.back().end == rows.begin)
        link.runs.back().end = rows.end;
      else
        link.runs.push_back(rows);
    });
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
  store.resize_for_ghosts(world.grain.rounder());
  brick_.cells.cover(world.grid, brick_.box);
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
