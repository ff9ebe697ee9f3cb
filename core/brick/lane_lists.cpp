#include <algorithm>

#include <barchan/core/base/stopwatch.hpp>
#include <barchan/core/brick/lane.hpp>

// Candidate lists of a lane, and the blocks in which the step walks over them.

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

}  // namespace

template <int Dim>
void Lane<Dim>::list_bonded() {
  bonded_.clear();
  for (std::size_t b = 0; b < bonds_.bonds().size(); ++b) {
    if (!bonds_.is_broken(static_cast<std::int32_t>(b)))
      bonded_.add(bonds_.bonds()[b].id_a, bonds_.bonds()[b].id_b);
  }
  bonded_.finish();
}

template <int Dim>
SearchRule Lane<Dim>::search_rule() const {
  return {world_->skin, world_->search, &world_->laws, &bonded_, world_->kernels.search};
}

template <int Dim>
void Lane<Dim>::list_owned() {
  const Stopwatch watch(search_seconds_.rebuild);
  find_owned();
}

template <int Dim>
void Lane<Dim>::find_owned() {
  const std::int32_t n = store_.num_owned;
  const std::int64_t slab_size = world_->grid.slab_size();
  band(Side::Left).rows = {
      0, band(Side::Left).exists ? cells_.first_row(slab_begin_ + 1, slab_size) : 0};
  band(Side::Right).rows = {
      band(Side::Right).exists ? cells_.first_row(slab_end_ - 1, slab_size) : n, n};
  planes_.write(world_->grid, store_, {0, n});
  resize_with_room(row_begin_, static_cast<std::size_t>(n));
  pairs_.clear();
  ContactSearch<Dim>(world_->grid, store_, planes_, search_rule())
      .owned(cells_, {0, n}, pairs_, row_begin_);
  pairs_.pad(store_.waste());
  pairs_.trim();
  pairs_.reset_history(history_form().length);
  cut_blocks();
}

template <int Dim>
void Lane<Dim>::cut_blocks() {
  blocks_.clear();
  travel_ = 0.0;
  if (packs()) pairs_.prepare_packing();
  // Rows before the next pair's first row are complete, but for those of bands.
  const std::int32_t first = band(Side::Left).rows.end,
                     last = std::max(first, band(Side::Right).rows.begin);
  for (std::int64_t k = 0; k < pairs_.size(); k += kBlockPairs) {
    Block& block = blocks_.emplace_back();
    block.begin = k, block.end = std::min(k + kBlockPairs, pairs_.size());
    const bool is_last = block.end == pairs_.size();
    block.final_row =
        is_last ? last : std::clamp(pairs_.i[static_cast<std::size_t>(block.end)], first, last);
  }
  if (blocks_.empty()) blocks_.emplace_back().final_row = last;
  chunks_ = {0, static_cast<int>(blocks_.size())};
  plan_prefetch();
}

template <int Dim>
void Lane<Dim>::cut_chunks(std::int64_t chunk_pairs) {
  chunks_ = {0};
  std::int64_t pairs = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    pairs += blocks_[b].end - blocks_[b].begin;
    if (b + 1 == blocks_.size() || pairs >= chunk_pairs) {
      chunks_.push_back(static_cast<int>(b) + 1);
      pairs = 0;
    }
  }
  std::int32_t row = band(Side::Left).rows.end;
  for (Block& block : blocks_) {
    const auto walls = walls_.list();
    const auto wall =
        std::lower_bound(walls.begin(), walls.end(), row,
                         [](const WallContact<Dim>& c, std::int32_t r) { return c.row < r; });
    block.has_extras = !bonds_.empty() || (wall != walls.end() && wall->row < block.final_row);
    row = std::max(row, block.final_row);
  }
}

template <int Dim>
void Lane<Dim>::list_across(Side side) {
  Band& band = this->band(side);
  if (!band.exists) return;
  band.across.clear();
  const std::int64_t slab_size = world_->grid.slab_size();
  CellIndex own;  // the band's slab alone
  own.slab_begin = side == Side::Left ? slab_begin_ : slab_end_ - 1;
  own.slab_end = own.slab_begin + 1;
  own.first_key = own.slab_begin * slab_size;
  const auto from = cells_.start.begin() + (own.slab_begin - slab_begin_) * slab_size;
  own.start.assign(from, from + slab_size + 1);
  band.planes.write(world_->grid, store_,
                    {band.ghost_cells.start.front(), band.ghost_cells.start.back()});
  ContactSearch<Dim>(world_->grid, store_, band.planes, search_rule())
      .across(own, band.ghost_cells, side == Side::Left ? -1 : 1, band.across);
  band.across.pad(store_.waste());
  band.across.trim();
  band.across.reset_history(history_form().length);
  if (packs()) band.across.prepare_packing();
  band.travel = 0.0;
  band.blocks = blocks_of(band.across);
}

template <int Dim>
void Lane<Dim>::research_owned() {
  const Stopwatch watch(search_seconds_.chunks);
  keep_histories(pairs_, kept_);
  find_owned();
  cut_chunks(std::int64_t{1} << 60);
  put_histories(pairs_, kept_);
}

template <int Dim>
void Lane<Dim>::research_across(Side side) {
  const Stopwatch watch(search_seconds_.bands);
  PairList& list = band(side).across;
  KeptContacts before;  // of its own: the other band may be at it too
  keep_histories(list, before);
  list_across(side);
  put_histories(list, before);
}

template <int Dim>
void Lane<Dim>::keep_histories(const PairList& list, KeptContacts& to) {
  to.clear(list.history_length);
  for (std::int64_t k = 0; k < list.size(); ++k) {
    if (!list.has_history(k)) continue;
    const auto pair = static_cast<std::size_t>(k);
    to.push({list.i[pair], list.j[pair]});
    keep(to, to.size() - 1, list, k, list.history_length);
  }
}

template <int Dim>
void Lane<Dim>::put_histories(PairList& list, const KeptContacts& kept) const {
  std::size_t at = 0;
  for (std::int64_t k = 0; k < list.size() && at < kept.size(); ++k) {
    const auto pair = static_cast<std::size_t>(k);
    if (list.i[pair] == store_.waste()) break;  // padding
    const std::array here{list.i[pair], list.j[pair]};
    while (at < kept.size() && kept.rows[at] < here) ++at;
    if (at == kept.size() || kept.rows[at] != here) continue;
    for (int c = 0; c < kept.length; ++c) list.history_of(k)[c * kBatch] = kept.history(at)[c];
  }
}

template <int Dim>
std::int64_t Lane<Dim>::num_pairs() const {
  std::int64_t n = pairs_.size();
  for (const Band& band : bands_) n += band.exists ? band.across.size() : 0;
  return n;
}

template <int Dim>
std::size_t Lane<Dim>::bytes() const {
  std::size_t total = store_.bytes() + pairs_.bytes() + bonds_.bytes() + planes_.bytes() +
                      kept_.bytes() + loose_.bytes() + 8 * row_begin_.capacity() +
                      4 * (cells_.start.capacity() + new_row_.capacity()) +
                      blocks_.capacity() * sizeof(Block) + walls_.bytes();
  for (const Band& band : bands_) total += band.across.bytes() + band.planes.bytes();
  return total;
}

template class Lane<2>;
template class Lane<3>;

}  // namespace barchan
