#include <algorithm>

#include <barchan/core/lane.hpp>
#include <barchan/core/stopwatch.hpp>

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
  bands_[Left].rows = {0, bands_[Left].exists ? cells_.first_row(slab_begin_ + 1, slab_size) : 0};
  bands_[Right].rows = {bands_[Right].exists ? cells_.first_row(slab_end_ - 1, slab_size) : n, n};
  // Pairs that wait, or are waited for, are those of the rows before `low` and from `high` on.
  const std::int32_t low = waits(Left) ? bands_[Left].rows.end : 0;
  const std::int32_t high =
      waits(Right) ? std::max(low, cells_.first_row(slab_end_ - 2, slab_size)) : n;

  planes_.write(store_, {0, n});
  const ContactSearch<Dim> search(world_->grid, store_, planes_, search_rule());
  resize_with_room(row_begin_, static_cast<std::size_t>(n));
  for (PairList& list : lists_) list.clear();
  search.owned(cells_, {0, low}, lists_[HeldLow], row_begin_);
  part(HeldLow, 0);
  search.owned(cells_, {low, high}, lists_[Owned], row_begin_);
  const std::int64_t from = lists_[Owned].size();
  search.owned(cells_, {high, n}, lists_[Owned], row_begin_);
  part(Owned, from);
  for (const ListName name : kLists) {
    PairList& list = lists_[name];
    list.pad(store_.waste());
    list.trim();
    list.template reset_springs<Dim>();
    if (name == HeldLow || name == HeldHigh) redirect(list);
  }
  cut_blocks();
}

/// The list of a pair of owned rows, the lower one first.
template <int Dim>
typename Lane<Dim>::ListName Lane<Dim>::list_of(std::int32_t low, std::int32_t high) const {
  const std::int32_t first = bands_[Left].rows.end, last = bands_[Right].rows.begin;
  if (waits(Left) && low < first) return high < first ? InnerLow : HeldLow;
  if (waits(Right) && high >= last) return low < last ? HeldHigh : InnerHigh;
  return Owned;
}

/// Moves pairs [from, end) of a list to where they belong; every list stays sorted.
template <int Dim>
void Lane<Dim>::part(ListName name, std::int64_t from) {
  PairList& list = lists_[name];
  const std::int64_t end = list.size();
  std::int64_t stays = from;
  std::int32_t row = -1;
  for (std::int64_t k = from; k < end; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const std::int32_t i = list.i[at], j = list.j[at];
    const ListName to = list_of(i, j);
    const std::int64_t place = to == name ? stays : lists_[to].size();
    if (to == name)
      list.copy(k, stays++);
    else
      lists_[to].push(i, j, list.code[at]);
    if (i == row || to == HeldLow || to == HeldHigh) continue;
    row_begin_[static_cast<std::size_t>(i)] = place;
    row = i;
  }
  list.shorten(stays);
}

template <int Dim>
void Lane<Dim>::redirect(PairList& list) const {
  const auto held = [this](std::int32_t i) {
    return (waits(Left) && i < bands_[Left].rows.end) ||
           (waits(Right) && i >= bands_[Right].rows.begin);
  };
  resize_with_room(list.result, list.i.size() * L::kForce);
  for (std::size_t k = 0; k < list.i.size(); ++k) {
    list.row_i.push_back(held(list.i[k]) ? store_.waste() : list.i[k]);
    list.row_j.push_back(held(list.j[k]) ? store_.waste() + 1 : list.j[k]);
  }
}

template <int Dim>
void Lane<Dim>::cut_blocks() {
  blocks_.clear();
  travel_ = 0.0;
  if (packs()) {
    for (PairList& list : lists_) list.prepare_packing();
  }
  // Rows are complete once all before the next pair's first row are done, in this list and in those
  // after it.
  const std::int32_t first = bands_[Left].rows.end, last = bands_[Right].rows.begin;
  for (const ListName name : {HeldLow, Owned, HeldHigh}) {
    const PairList& list = lists_[name];
    const std::int32_t held = lists_[HeldHigh].size() > 0 ? lists_[HeldHigh].i[0] : last;
    const std::int32_t most = name == HeldLow ? first : name == Owned ? held : last;
    for (std::int64_t k = 0; k < list.size(); k += kBlockPairs) {
      Block& block = blocks_.emplace_back();
      block.list = name, block.begin = k, block.end = std::min(k + kBlockPairs, list.size());
      block.final_row =
          block.end < list.size() ? list.i[static_cast<std::size_t>(block.end)] : most;
      block.final_row = std::clamp(block.final_row, first, std::max(first, most));
    }
  }
  if (blocks_.empty() || blocks_.back().final_row < last)
    blocks_.emplace_back(), blocks_.back().list = Owned, blocks_.back().final_row = last;
  chunks_ = {0, static_cast<int>(blocks_.size())};
  bands_[Left].inner_blocks = blocks_of(lists_[InnerLow]);
  bands_[Right].inner_blocks = blocks_of(lists_[InnerHigh]);
  plan_prefetch();
}

template <int Dim>
void Lane<Dim>::cut_chunks(std::int64_t chunk_pairs) {
  const auto touches_left = [this](const Block& block) {
    const PairList& list = lists_[static_cast<std::size_t>(block.list)];
    return block.begin < block.end &&
           list.i[static_cast<std::size_t>(block.begin)] < bands_[Left].rows.end;
  };
  chunks_ = {0};
  std::int64_t pairs = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    // Everything that the left band waits for is in the first chunk.
    pairs += blocks_[b].end - blocks_[b].begin;
    const bool is_last = b + 1 == blocks_.size();
    if (is_last || (pairs >= chunk_pairs && !touches_left(blocks_[b + 1]))) {
      chunks_.push_back(static_cast<int>(b) + 1);
      pairs = 0;
    }
  }
  std::int32_t row = bands_[Left].rows.end;
  for (Block& block : blocks_) {
    const auto& walls = walls_.list();
    const auto wall =
        std::lower_bound(walls.begin(), walls.end(), row,
                         [](const WallContact<Dim>& c, std::int32_t r) { return c.row < r; });
    block.has_extras = !bonds_.empty() || (wall != walls.end() && wall->row < block.final_row);
    row = std::max(row, block.final_row);
  }
}

template <int Dim>
void Lane<Dim>::list_across(Side side) {
  Band& band = bands_[side];
  if (!band.exists) return;
  band.across.clear();
  const std::int64_t slab_size = world_->grid.slab_size();
  CellIndex own;  // the band's slab alone
  own.slab_begin = side == Left ? slab_begin_ : slab_end_ - 1;
  own.slab_end = own.slab_begin + 1;
  own.first_key = own.slab_begin * slab_size;
  const auto from = cells_.start.begin() + (own.slab_begin - slab_begin_) * slab_size;
  own.start.assign(from, from + slab_size + 1);
  const int towards = side == Left ? -1 : 1;  // from owned to ghost
  const CellIndex& lower = band.ghosts_first ? band.ghost_cells : own;
  const CellIndex& higher = band.ghosts_first ? own : band.ghost_cells;
  band.planes.write(store_, {higher.start.front(), higher.start.back()});
  ContactSearch<Dim>(world_->grid, store_, band.planes, search_rule())
      .across(lower, higher, band.ghosts_first ? -towards : towards, band.across);
  band.across.pad(store_.waste());
  band.across.trim();
  band.across.template reset_springs<Dim>();
  band.across.result.resize(band.returns ? band.across.i.size() * L::kForce : 0);
  if (packs()) band.across.prepare_packing();
  band.travel = 0.0;
  band.blocks = blocks_of(band.across);
}

template <int Dim>
void Lane<Dim>::research_owned() {
  const Stopwatch watch(search_seconds_.chunks);
  kept_.clear();
  for (const PairList& list : lists_) keep_springs(list, kept_);
  const auto precedes = [](const KeptContact& p, const KeptContact& q) {
    return std::pair(p.i, p.j) < std::pair(q.i, q.j);
  };
  std::sort(kept_.begin(), kept_.end(), precedes);
  find_owned();
  cut_chunks(std::int64_t{1} << 60);
  for (PairList& list : lists_) put_springs(list, kept_);
}

template <int Dim>
void Lane<Dim>::research_across(Side side) {
  const Stopwatch watch(search_seconds_.bands);
  PairList& list = bands_[side].across;
  std::vector<KeptContact> before;  // of its own: the other band may be at it too
  keep_springs(list, before);
  list_across(side);
  put_springs(list, before);
}

template <int Dim>
void Lane<Dim>::keep_springs(const PairList& list, std::vector<KeptContact>& to) {
  for (std::int64_t k = 0; k < list.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (list.template has_spring<Dim>(k)) keep(to.emplace_back(), list, k, list.i[at], list.j[at]);
  }
}

template <int Dim>
void Lane<Dim>::put_springs(PairList& list, std::span<const KeptContact> kept) const {
  for (std::int64_t k = 0; k < list.size() && !kept.empty(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (list.i[at] == store_.waste()) break;  // padding
    const std::pair here(list.i[at], list.j[at]);
    const auto of_front = [&] { return std::pair(kept.front().i, kept.front().j); };
    while (!kept.empty() && of_front() < here) kept = kept.subspan(1);
    if (kept.empty() || of_front() != here) continue;
    for (int c = 0; c < L::kSprings; ++c)
      list.template springs<Dim>(k)[c * kBatch] = kept.front().spring[c];
  }
}

template <int Dim>
std::int64_t Lane<Dim>::num_pairs() const {
  std::int64_t n = 0;
  for (const PairList& list : lists_) n += list.size();
  for (const Band& band : bands_) n += band.exists ? band.across.size() : 0;
  return n;
}

template <int Dim>
std::size_t Lane<Dim>::bytes() const {
  std::size_t total =
      store_.bytes() + bonds_.bytes() + planes_.bytes() + kept_.capacity() * sizeof(KeptContact) +
      loose_.capacity() * sizeof(LooseContact<Dim>) + 8 * row_begin_.capacity() +
      4 * (cells_.start.capacity() + new_row_.capacity()) + blocks_.capacity() * sizeof(Block) +
      walls_.list().capacity() * sizeof(WallContact<Dim>);
  for (const PairList& list : lists_) total += list.bytes();
  for (const Band& band : bands_) total += band.across.bytes() + band.planes.bytes();
  return total;
}

template class Lane<2>;
template class Lane<3>;

}  // namespace barchan
