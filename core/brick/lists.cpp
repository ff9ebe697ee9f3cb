#include <barchan/core/brick/lists.hpp>

#include <algorithm>
#include <utility>

#include <barchan/core/base/clock.hpp>
#include <barchan/core/brick/prefetch.hpp>

namespace barchan {
namespace {

std::vector<PairBlock> blocks_of(const PairList& list) {
  std::vector<PairBlock> blocks;
  for (std::int64_t k = 0; k < list.size(); k += kBlockPairs) {
    PairBlock& block = blocks.emplace_back();
    block.begin = k, block.end = std::min(k + kBlockPairs, list.size());
  }
  return blocks;
}

/// @param waste  first of the rows that pad the list
PairPlace find_pair(PairList& list, std::int32_t waste,
                    std::pair<std::int32_t, std::int32_t> wanted) {
  std::int64_t low = 0, high = list.size();
  while (low < high && list.i[static_cast<std::size_t>(high - 1)] == waste) --high;
  while (low < high) {
    const std::int64_t mid = (low + high) / 2;
    const auto m = static_cast<std::size_t>(mid);
    if (std::pair(list.i[m], list.j[m]) < wanted)
      low = mid + 1;
    else
      high = mid;
  }
  const auto at = static_cast<std::size_t>(low);
  if (low == list.size() || std::pair(list.i[at], list.j[at]) != wanted) return {};
  return {&list, low};
}

/// A list with all its pairs, ready for a step.
template <int Dim>
void finish(PairList& list, const World<Dim>& world, std::int32_t waste) {
  list.pad(waste);
  list.trim();
  list.reset_history(world.history_form().length);
  if (world.packs()) list.prepare_packing();
}

}  // namespace

template <int Dim>
PairPlace owned_place(Brick<Dim>& brick, std::int32_t low, std::int32_t high) {
  PairList& pairs = brick.pairs;
  for (std::int64_t k = brick.row_begin[static_cast<std::size_t>(low)];
       k < pairs.size() && pairs.i[static_cast<std::size_t>(k)] == low; ++k) {
    if (pairs.j[static_cast<std::size_t>(k)] == high) return {&pairs, k};
  }
  return {};
}

template <int Dim>
PairPlace place_of(Brick<Dim>& brick, std::int32_t a, std::int32_t b) {
  const ParticleStore<Dim>& store = brick.store;
  if (store.is_owned(a) && store.is_owned(b))
    return owned_place(brick, std::min(a, b), std::max(a, b));
  const std::int32_t ghost = store.is_owned(a) ? b : a, own = store.is_owned(a) ? a : b;
  Band& band = brick.band(ghost < store.ghost_begin(Side::Right) ? Side::Left : Side::Right);
  return find_pair(band.across, store.waste(), {own, ghost});
}

template <int Dim>
void Lists<Dim>::list_bonded() {
  const auto& bonds = brick_.bonds.bonds();
  brick_.bonded.clear();
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    if (!brick_.bonds.is_broken(static_cast<std::int32_t>(b)))
      brick_.bonded.add(bonds[b].id_a, bonds[b].id_b);
  }
  brick_.bonded.finish();
}

template <int Dim>
SearchRule Lists<Dim>::rule() const {
  const World<Dim>& world = *brick_.world;
  return {world.skin + world.range, world.search, &world.laws, &brick_.bonded,
          world.kernels.search};
}

template <int Dim>
void Lists<Dim>::list_owned() {
  const Stopwatch watch(seconds_.rebuild);
  find_owned();
}

template <int Dim>
void Lists<Dim>::list_across(Side side) {
  const Stopwatch watch(seconds_.rebuild);
  find_across(side);
}

template <int Dim>
void Lists<Dim>::find_owned() {
  const World<Dim>& world = *brick_.world;
  const ParticleStore<Dim>& store = brick_.store;
  const std::int32_t n = store.num_owned;
  planes_.write(world.grid, store, {0, n});
  resize_with_room(brick_.row_begin, static_cast<std::size_t>(n));
  brick_.pairs.clear();
  ContactSearch<Dim>(world.grid, store, planes_, rule())
      .owned(brick_.cells, brick_.pairs, brick_.row_begin);
  finish(brick_.pairs, world, store.waste());
  cut_blocks();
}

template <int Dim>
void Lists<Dim>::cut_blocks() {
  const PairList& pairs = brick_.pairs;
  std::vector<RowBlock>& blocks = brick_.blocks;
  blocks.clear();
  brick_.travel = 0.0;
  // Rows before the next pair's first row are complete, but for those of bands.
  const auto [first, last] = brick_.interior;
  for (std::int64_t k = 0; k < pairs.size(); k += kBlockPairs) {
    RowBlock& block = blocks.emplace_back();
    block.begin = k, block.end = std::min(k + kBlockPairs, pairs.size());
    const bool is_last = block.end == pairs.size();
    block.final_row =
        is_last ? last : std::clamp(pairs.i[static_cast<std::size_t>(block.end)], first, last);
  }
  if (blocks.empty()) blocks.emplace_back().final_row = last;
  brick_.chunks = {0, static_cast<int>(blocks.size())};
  plan_prefetch(brick_);
}

template <int Dim>
void Lists<Dim>::cut_chunks(std::int64_t chunk_pairs) {
  brick_.chunks = {0};
  std::int64_t pairs = 0;
  for (std::size_t b = 0; b < brick_.blocks.size(); ++b) {
    pairs += brick_.blocks[b].end - brick_.blocks[b].begin;
    if (b + 1 == brick_.blocks.size() || pairs >= chunk_pairs) {
      brick_.chunks.push_back(static_cast<int>(b) + 1);
      pairs = 0;
    }
  }
  std::int32_t row = brick_.interior.begin;
  const auto walls = brick_.walls.list();
  for (RowBlock& block : brick_.blocks) {
    const auto wall =
        std::lower_bound(walls.begin(), walls.end(), row,
                         [](const WallContact<Dim>& c, std::int32_t r) { return c.row < r; });
    block.has_extras =
        !brick_.bonds.empty() || (wall != walls.end() && wall->row < block.final_row);
    row = std::max(row, block.final_row);
  }
}

template <int Dim>
void Lists<Dim>::find_across(Side side) {
  Band& band = brick_.band(side);
  if (!band.exists) return;
  const World<Dim>& world = *brick_.world;
  const Rows ghosts = brick_.store.ghosts(side);
  band.across.clear();
  band.planes.write(world.grid, brick_.store, ghosts);
  ContactSearch<Dim>(world.grid, brick_.store, band.planes, rule())
      .across(brick_.cells, band.near, ghosts, band.across);
  finish(band.across, world, brick_.store.waste());
  band.travel = 0.0;
  band.blocks = blocks_of(band.across);
}

template <int Dim>
void Lists<Dim>::search_owned_again() {
  const Stopwatch watch(seconds_.chunks);
  keep(brick_.pairs, kept_);
  find_owned();
  cut_chunks(std::int64_t{1} << 60);
  put_back(brick_.pairs, kept_);
}

template <int Dim>
void Lists<Dim>::search_across_again(Side side) {
  const Stopwatch watch(seconds_.bands);
  PairList& list = brick_.band(side).across;
  KeptContacts before;  // of its own: the other band may be at it too
  keep(list, before);
  find_across(side);
  put_back(list, before);
}

template <int Dim>
void Lists<Dim>::keep(const PairList& list, KeptContacts& to) {
  to.clear(list.history_length);
  for (std::int64_t k = 0; k < list.size(); ++k) {
    if (!list.has_history(k)) continue;
    const auto pair = static_cast<std::size_t>(k);
    double* numbers = to.push({list.i[pair], list.j[pair]});
    for (int c = 0; c < to.length; ++c) numbers[c] = list.history_of(k)[c * kBatch];
  }
}

template <int Dim>
void Lists<Dim>::put_back(PairList& list, const KeptContacts& kept) const {
  std::size_t at = 0;
  for (std::int64_t k = 0; k < list.size() && at < kept.size(); ++k) {
    const auto pair = static_cast<std::size_t>(k);
    if (list.i[pair] == brick_.store.waste()) break;  // padding
    const std::array here{list.i[pair], list.j[pair]};
    while (at < kept.size() && kept.rows[at] < here) ++at;
    if (at == kept.size() || kept.rows[at] != here) continue;
    for (int c = 0; c < kept.length; ++c) list.history_of(k)[c * kBatch] = kept.history(at)[c];
  }
}

template PairPlace owned_place(Brick<2>&, std::int32_t, std::int32_t);
template PairPlace owned_place(Brick<3>&, std::int32_t, std::int32_t);
template PairPlace place_of(Brick<2>&, std::int32_t, std::int32_t);
template PairPlace place_of(Brick<3>&, std::int32_t, std::int32_t);
template class Lists<2>;
template class Lists<3>;

}  // namespace barchan
