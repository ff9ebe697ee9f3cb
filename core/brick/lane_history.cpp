#include <algorithm>
#include <cstdlib>
#include <string>

#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/lane.hpp>

// Contact history on its way through a rebuild. Pairs of rows that both stay are carried by row;
// all others as loose contacts, by the row of one particle and the id of the other.

namespace barchan {
namespace {

/// A longer bond would reach past a band to rows that do not wait for ghosts. Refused on one rank
/// too, where it would do no harm, so that a run does not depend on the number of ranks.
template <int Dim>
void require_short_bonds(const Grid<Dim>& grid, const ParticleStore<Dim>& store,
                         const BondSet<Dim>& bonds) {
  const auto slab = [&](std::int32_t row) {
    return static_cast<int>(store.key[static_cast<std::size_t>(row)] / grid.slab_size());
  };
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(bonds.bonds().size()); ++b) {
    int apart = std::abs(slab(bonds.end_a(b)) - slab(bonds.end_b(b)));
    if (grid.is_periodic(0)) apart = std::min(apart, grid.num_slabs() - apart);
    if (apart <= 1) continue;
    const auto& bond = bonds.bonds()[static_cast<std::size_t>(b)];
    throw RunError("the bond between particles " + std::to_string(bond.id_a) + " and " +
                   std::to_string(bond.id_b) +
                   " has grown longer than a cell is wide: give it a tensile strength, or a larger "
                   "search.skin");
  }
}

}  // namespace

// Packed histories are taken from where they are: these lists have served.
template <int Dim>
void Lane<Dim>::collect_history(std::array<Migration<Dim>, 2>& leaving,
                                std::span<const std::int32_t> number) {
  kept_.clear(history_form().length);
  for (const Block& block : blocks_) keep_staying(block, leaving, number);
  imbalance_.contacts -= static_cast<std::int64_t>(kept_.size());
  kept_.trim(kBlockPairs);
  for (const Side side : kSides) {
    const PairList& list = band(side).across;
    for (const PairBlock& block : band(side).blocks) {
      block.for_each_worked_on(list, [&](std::size_t k, std::int32_t i, std::int32_t j) {
        loosen(list, static_cast<std::int64_t>(k), {i, j}, side == Side::Left, leaving, number);
      });
    }
  }
}

/// Pairs of two that stay are the rule, and nobody can foretell which near pairs have a history.
template <int Dim>
void Lane<Dim>::keep_staying(const PairBlock& block, std::array<Migration<Dim>, 2>& leaving,
                             std::span<const std::int32_t> number) {
  const auto stays = [this](std::int32_t row) {
    return store_.is_owned(row) && goes_[static_cast<std::size_t>(row)] == 0;
  };
  std::size_t count = kept_.size();
  kept_.resize(count + static_cast<std::size_t>(block.num_worked_on()));
  with_length<Dim>(kept_.length, [&](auto length) {
    block.for_each_worked_on(pairs_, [&](std::size_t at, std::int32_t i, std::int32_t j) {
      const auto k = static_cast<std::int64_t>(at);
      if (!stays(i) || !stays(j)) return loosen(pairs_, k, {i, j}, true, leaving, number);
      kept_.rows[count] = {i, j};
      keep(kept_, count, pairs_, k, length);
      count += pairs_.has_history(k, length) ? 1 : 0;
    });
  });
  kept_.resize(count);
}

template <int Dim>
void Lane<Dim>::loosen(const PairList& list, std::int64_t k, std::array<std::int32_t, 2> ends,
                       bool counts, std::array<Migration<Dim>, 2>& leaving,
                       std::span<const std::int32_t> number) {
  if (!list.has_history(k) || is_removed(ends[0]) || is_removed(ends[1])) return;
  if (counts) --imbalance_.contacts;
  for (std::size_t e = 0; e < 2; ++e) {
    if (!store_.is_owned(ends[e])) continue;
    const auto own = static_cast<std::size_t>(ends[e]);
    if (goes_[own] == kGone) continue;
    const bool leaves = goes_[own] != 0;
    auto& to = leaves ? leaving[static_cast<std::size_t>(goes_[own] - 1)].contacts : loose_;
    double* numbers =
        to.push({leaves ? number[own] : ends[e], store_.id[static_cast<std::size_t>(ends[1 - e])]});
    for (int c = 0; c < to.length; ++c)
      numbers[c] = history_form().sign(c, e == 1) * list.history_of(k)[c * kBatch];
  }
}

template <int Dim>
typename Lane<Dim>::Slot Lane<Dim>::owned_slot(std::int32_t low, std::int32_t high) {
  for (std::int64_t k = row_begin_[static_cast<std::size_t>(low)];
       k < pairs_.size() && pairs_.i[static_cast<std::size_t>(k)] == low; ++k) {
    if (pairs_.j[static_cast<std::size_t>(k)] == high) return {&pairs_, k};
  }
  return {};
}

template <int Dim>
typename Lane<Dim>::Slot Lane<Dim>::slot(std::int32_t a, std::int32_t b) {
  if (store_.is_owned(a) && store_.is_owned(b)) return owned_slot(std::min(a, b), std::max(a, b));
  const std::int32_t ghost = store_.is_owned(a) ? b : a, own = store_.is_owned(a) ? a : b;
  Band& band = this->band(ghost < store_.ghost_begin(Side::Right) ? Side::Left : Side::Right);
  return find_pair(band.across, {own, ghost});
}

template <int Dim>
typename Lane<Dim>::Slot Lane<Dim>::find_pair(PairList& list,
                                              std::pair<std::int32_t, std::int32_t> wanted) const {
  std::int64_t low = 0, high = list.size();
  while (low < high && list.i[static_cast<std::size_t>(high - 1)] == store_.waste()) --high;
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

template <int Dim>
std::int32_t Lane<Dim>::find_near(std::int32_t row, std::int64_t id) const {
  const std::int64_t key = store_.key[static_cast<std::size_t>(row)];
  Neighbourhood<Dim> around;
  const auto look = [&](const CellIndex& cells) {
    around.collect(world_->grid, cells, key, -1, 1, -1);
    for (int q = 0; q < around.count; ++q) {
      const Rows rows = around.ranges[static_cast<std::size_t>(q)];
      for (std::int32_t j = rows.begin; j < rows.end; ++j) {
        if (store_.id[static_cast<std::size_t>(j)] == id) return j;
      }
    }
    return std::int32_t{-1};
  };
  std::int32_t found = look(cells_);
  for (const Band& band : bands_) {
    if (found < 0 && band.exists) found = look(band.ghost_cells);
  }
  return found;
}

/// @return whether they are candidates: if not, they are out of touch
template <int Dim>
bool Lane<Dim>::place(std::int32_t a, std::int32_t b, const double* history) {
  const Slot at = slot(a, b);
  if (at.list == nullptr) return false;
  if (at.list == &band(Side::Right).across && band(Side::Right).returns)
    return true;  // kept by the right-hand side
  // What comes from both sides, and what the lane right of a cut counts, is not counted again.
  const bool counts = at.list != &band(Side::Right).across && !at.list->has_history(at.k);
  if (counts) ++imbalance_.contacts;
  put(at, at.list->i[static_cast<std::size_t>(at.k)] != a, history);
  return true;
}

template <int Dim>
void Lane<Dim>::put(const Slot& at, bool is_swapped, const double* history) const {
  const History& form = history_form();
  for (int c = 0; c < form.length; ++c)
    at.list->history_of(at.k)[c * kBatch] = form.sign(c, is_swapped) * history[c];
}

template <int Dim>
void Lane<Dim>::restore_history() {
  // Fast ones may have parted in the last step by more than the skin: nothing is lost then.
  const auto touch = [this](std::int32_t a, std::int32_t b) {
    const double reach = store_.radius(a) + store_.radius(b);
    return distance2<Dim>(world_->grid.box(), store_.x(a), store_.x(b)) < reach * reach;
  };
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    if (loses(Loss::Contact)) continue;
    const std::int32_t a = new_row_[static_cast<std::size_t>(kept_.rows[k][0])],
                       b = new_row_[static_cast<std::size_t>(kept_.rows[k][1])];
    const Slot at = owned_slot(std::min(a, b), std::max(a, b));
    if (at.list != nullptr) put(at, a > b, kept_.history(k));
    if (at.list != nullptr || !touch(a, b)) ++imbalance_.contacts;
  }
  kept_.clear(kept_.length);
  for (std::size_t k = 0; k < loose_.size(); ++k) {
    const LooseContact& c = loose_.rows[k];
    const std::int32_t row = new_row_[static_cast<std::size_t>(c.handle)];
    const std::int32_t partner = find_near(row, c.partner);
    // Of two that parted, both ends come here; the lower id counts.
    if ((partner < 0 || (!place(row, partner, loose_.history(k)) && !touch(row, partner))) &&
        store_.id[static_cast<std::size_t>(row)] < c.partner)
      ++imbalance_.contacts;
  }
  loose_.clear(loose_.length);
  bonds_.resolve(store_);
  require_short_bonds(world_->grid, store_, bonds_);
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(bonds_.bonds().size()); ++b)
    imbalance_.bonds += counts_bond(b) ? 1 : 0;

  restore_wall_history();
  removed_.clear();
  find_quick();
}

/// After rows have come and gone, and lists have another skin.
template <int Dim>
void Lane<Dim>::find_quick() {
  has_quick_ = false;
  judge_speeds({0, store_.num_owned});
  for (const Side side : kSides) {
    const std::int32_t begin = store_.ghost_begin(side);
    const Rows ghosts{begin, begin + store_.num_ghosts[index_of(side)]};
    band(side).has_quick = farthest_travel(store_, world_->dt, ghosts) > world_->quick_travel;
  }
}

template <int Dim>
void Lane<Dim>::restore_wall_history() {
  walls_.search(store_, world_->wall_view(), world_->skin);
  for (WallContact<Dim>& c : old_walls_) c.row = new_row_[static_cast<std::size_t>(c.row)];
  std::sort(old_walls_.begin(), old_walls_.end(),
            [](const auto& p, const auto& q) { return key_of(p) < key_of(q); });
  const auto touches = [this](const WallContact<Dim>& c) {
    const auto w = static_cast<std::size_t>(c.wall);
    return world_->wall_shapes[w].foot(world_->walls[w].point, c.image, store_.x(c.row)).distance <
           store_.radius(c.row);
  };
  auto now = walls_.list().begin();
  for (const WallContact<Dim>& old : old_walls_) {
    while (now != walls_.list().end() && key_of(*now) < key_of(old)) ++now;
    const bool is_listed = now != walls_.list().end() && key_of(*now) == key_of(old);
    if (!has_history(old) || (is_listed ? loses(Loss::WallContact) : touches(old))) continue;
    if (is_listed) std::copy_n(old.history, int{kLongestHistory<Dim>}, now->history);
    ++imbalance_.wall_contacts;
  }
  old_walls_.clear();
}

template class Lane<2>;
template class Lane<3>;

}  // namespace barchan
