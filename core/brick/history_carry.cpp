#include <barchan/core/brick/history_carry.hpp>

#include <algorithm>

namespace barchan {

bool Leavers::is_removed(std::int64_t id) const {
  return !removed.empty() && std::binary_search(removed.begin(), removed.end(), id);
}

template <int Dim>
void HistoryCarry<Dim>::clear() {
  const int length = brick_.world->history_form().length;
  kept_.clear(length);
  loose_.clear(length);
  walls_.clear();
}

// Packed histories are taken from where they are: these lists have served.
template <int Dim>
void HistoryCarry<Dim>::collect(const Leavers& leavers, std::vector<Migration<Dim>>& out) {
  clear();
  const Way way{leavers, out};
  for (Migration<Dim>& m : out) m.contacts.length = kept_.length;
  for (const RowBlock& block : brick_.blocks) keep_staying(block, way);
  imbalance_.contacts -= static_cast<std::int64_t>(kept_.size());
  kept_.trim(kBlockPairs);
  for (const Side side : kSides) {
    const Band& band = brick_.band(side);
    for (const PairBlock& block : band.blocks) {
      block.for_each_worked_on(band.across, [&](std::size_t k, std::int32_t i, std::int32_t j) {
        loosen(band.across, k, {i, j}, side == Side::Left, way);
      });
    }
  }
  collect_walls(way);
}

/// Pairs of two that stay are the rule, and nobody can foretell which near pairs have a history.
template <int Dim>
void HistoryCarry<Dim>::keep_staying(const PairBlock& block, const Way& way) {
  const PairList& pairs = brick_.pairs;
  const auto stays = [&](std::int32_t row) {
    return brick_.store.is_owned(row) && way.leavers.of(row) == Leavers::Stays;
  };
  std::size_t count = kept_.size();
  kept_.resize(count + static_cast<std::size_t>(block.num_worked_on()));
  with_length<Dim>(kept_.length, [&](auto length) {
    block.for_each_worked_on(pairs, [&](std::size_t k, std::int32_t i, std::int32_t j) {
      if (!stays(i) || !stays(j)) return loosen(pairs, k, {i, j}, true, way);
      kept_.rows[count] = {i, j};
      double* numbers = kept_.numbers.data() + count * static_cast<std::size_t>(length);
      const double* from = pairs.history.data() +
                           k / kBatch * kBatch * static_cast<std::size_t>(length) + k % kBatch;
      bool has_any = false;
      for (int c = 0; c < length; ++c) {
        numbers[c] = from[c * kBatch];
        has_any = has_any | (numbers[c] != 0.0);
      }
      count += has_any ? 1 : 0;
    });
  });
  kept_.resize(count);
}

/// @param counts  the pair counts in this brick
template <int Dim>
void HistoryCarry<Dim>::loosen(const PairList& list, std::size_t k,
                               std::array<std::int32_t, 2> ends, bool counts, const Way& way) {
  const auto& id = brick_.store.id;
  const std::array<std::int64_t, 2> ids{id[static_cast<std::size_t>(ends[0])],
                                        id[static_cast<std::size_t>(ends[1])]};
  const auto pair = static_cast<std::int64_t>(k);
  if (!list.has_history(pair) || way.leavers.is_removed(ids[0]) || way.leavers.is_removed(ids[1]))
    return;
  if (counts) --imbalance_.contacts;
  const History& form = brick_.world->history_form();
  for (std::size_t e = 0; e < 2; ++e) {
    const std::int32_t own = ends[e];
    if (!brick_.store.is_owned(own) || way.leavers.of(own) == Leavers::Gone) continue;
    double* numbers = way.leavers.leaves(own)
                          ? way.message_of(own).contacts.push({way.number_of(own), ids[1 - e]})
                          : loose_.push({own, ids[1 - e]});
    for (int c = 0; c < form.length; ++c)
      numbers[c] = form.sign(c, e == 1) * list.history_of(pair)[c * kBatch];
  }
}

template <int Dim>
void HistoryCarry<Dim>::collect_walls(const Way& way) {
  for (const WallContact<Dim>& c : brick_.walls.list()) {
    if (way.leavers.of(c.row) == Leavers::Gone) continue;
    if (has_history(c)) --imbalance_.wall_contacts;
    if (!way.leavers.leaves(c.row)) {
      walls_.push_back(c);
      continue;
    }
    WallRecord<Dim> w{way.number_of(c.row), c.wall, c.image, {}};
    std::copy_n(c.history, int{kLongestHistory<Dim>}, w.history);
    way.message_of(c.row).walls.push_back(w);
  }
}

/// Of two ends that are known here either may be what the history is of: both get it.
template <int Dim>
void HistoryCarry<Dim>::copy(std::span<const std::int32_t> new_row, std::span<const Rows> of,
                             std::vector<Migration<Dim>>& out) const {
  const History& form = brick_.world->history_form();
  const auto& id = brick_.store.id;
  const auto place_of = [&](std::int32_t row) {
    return std::ranges::find_if(
               of, [row](const Rows& rows) { return row >= rows.begin && row < rows.end; }) -
           of.begin();
  };
  const auto give = [&](std::int32_t row, std::int64_t partner, bool is_swapped,
                        const double* from) {
    const auto at = static_cast<std::size_t>(place_of(row));
    if (row < 0 || at == of.size()) return;
    double* numbers = out[at].contacts.push({row - of[at].begin, partner});
    for (int c = 0; c < form.length; ++c) numbers[c] = form.sign(c, is_swapped) * from[c];
  };
  const auto row_of = [&](std::int32_t source) {
    return new_row[static_cast<std::size_t>(source)];
  };
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    const std::int32_t a = row_of(kept_.rows[k][0]), b = row_of(kept_.rows[k][1]);
    give(a, id[static_cast<std::size_t>(b)], false, kept_.history(k));
    give(b, id[static_cast<std::size_t>(a)], true, kept_.history(k));
  }
  for (std::size_t k = 0; k < loose_.size(); ++k) {
    const std::int32_t row = row_of(loose_.rows[k].handle);
    const std::int64_t partner = loose_.rows[k].partner;
    give(row, partner, false, loose_.history(k));
    give(find_near(row, partner), id[static_cast<std::size_t>(row)], true, loose_.history(k));
  }
  for (const WallContact<Dim>& c : walls_) {
    const std::int32_t row = row_of(c.row);
    const auto at = static_cast<std::size_t>(place_of(row));
    if (at == of.size()) continue;
    WallRecord<Dim>& w = out[at].walls.emplace_back();
    w = {row - of[at].begin, c.wall, c.image, {}};
    std::copy_n(c.history, int{kLongestHistory<Dim>}, w.history);
  }
}

template <int Dim>
void HistoryCarry<Dim>::put_back(std::span<const std::int32_t> new_row) {
  put_back_kept(new_row);
  put_back_loose(new_row);
  put_back_walls(new_row);
  clear();
}

/// Fast ones may have parted in the last step by more than the skin: nothing is lost then.
template <int Dim>
bool HistoryCarry<Dim>::may_hold(std::int32_t a, std::int32_t b) const {
  const ParticleStore<Dim>& store = brick_.store;
  const double reach = store.radius(a) + store.radius(b) + brick_.world->range;
  return distance2<Dim>(brick_.world->grid.box(), store.x(a), store.x(b)) < reach * reach;
}

template <int Dim>
void HistoryCarry<Dim>::put_back_kept(std::span<const std::int32_t> new_row) {
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    if (loses(Loss::Contact)) continue;
    const std::int32_t a = new_row[static_cast<std::size_t>(kept_.rows[k][0])],
                       b = new_row[static_cast<std::size_t>(kept_.rows[k][1])];
    const PairPlace at = owned_place(brick_, std::min(a, b), std::max(a, b));
    if (at.list != nullptr) put(at, a > b, kept_.history(k));
    if (at.list != nullptr || !may_hold(a, b)) ++imbalance_.contacts;
  }
}

template <int Dim>
void HistoryCarry<Dim>::put_back_loose(std::span<const std::int32_t> new_row) {
  for (std::size_t k = 0; k < loose_.size(); ++k) {
    const LooseContact& c = loose_.rows[k];
    const std::int32_t row = new_row[static_cast<std::size_t>(c.handle)];
    const std::int32_t partner = find_near(row, c.partner);
    // Of two that parted, both ends come here; the lower id counts.
    if ((partner < 0 || (!place(row, partner, loose_.history(k)) && !may_hold(row, partner))) &&
        brick_.store.id[static_cast<std::size_t>(row)] < c.partner)
      ++imbalance_.contacts;
  }
}

template <int Dim>
void HistoryCarry<Dim>::put_back_walls(std::span<const std::int32_t> new_row) {
  const World<Dim>& world = *brick_.world;
  for (WallContact<Dim>& c : walls_) c.row = new_row[static_cast<std::size_t>(c.row)];
  std::sort(walls_.begin(), walls_.end(),
            [](const auto& p, const auto& q) { return key_of(p) < key_of(q); });
  const auto holds = [&](const WallContact<Dim>& c) {
    const auto w = static_cast<std::size_t>(c.wall);
    const WallFoot foot =
        world.wall_shapes[w].foot(world.walls[w].point, c.image, brick_.store.x(c.row));
    return foot.distance < brick_.store.radius(c.row) + world.range;
  };
  auto now = brick_.walls.list().begin();
  const auto end = brick_.walls.list().end();
  for (const WallContact<Dim>& old : walls_) {
    while (now != end && key_of(*now) < key_of(old)) ++now;
    const bool is_listed = now != end && key_of(*now) == key_of(old);
    if (!has_history(old) || (is_listed ? loses(Loss::WallContact) : holds(old))) continue;
    if (is_listed) std::copy_n(old.history, int{kLongestHistory<Dim>}, now->history);
    ++imbalance_.wall_contacts;
  }
}

template <int Dim>
std::int32_t HistoryCarry<Dim>::find_near(std::int32_t row, std::int64_t id) const {
  const ParticleStore<Dim>& store = brick_.store;
  Neighbourhood<Dim> around;
  around.collect(brick_.cells,
                 cell_of_key(brick_.world->grid, store.key[static_cast<std::size_t>(row)]),
                 {0, store.size()});
  for (int q = 0; q < around.count; ++q) {
    const Rows rows = around.ranges[static_cast<std::size_t>(q)];
    for (std::int32_t j = rows.begin; j < rows.end; ++j) {
      if (store.id[static_cast<std::size_t>(j)] == id) return j;
    }
  }
  return -1;
}

/// @return whether they are candidates: if not, they are out of touch
template <int Dim>
bool HistoryCarry<Dim>::place(std::int32_t a, std::int32_t b, const double* history) {
  const PairPlace at = place_of(brick_, a, b);
  if (at.list == nullptr) return false;
  const Band& right = brick_.band(Side::Right);
  const bool is_right = at.list == &right.across;
  if (is_right && right.returns) return true;  // kept by the right-hand side
  // What comes from both sides, and what the lane right of a cut counts, is not counted again.
  if (!is_right && !at.list->has_history(at.k)) ++imbalance_.contacts;
  put(at, at.list->i[static_cast<std::size_t>(at.k)] != a, history);
  return true;
}

template <int Dim>
void HistoryCarry<Dim>::put(const PairPlace& at, bool is_swapped, const double* history) const {
  const History& form = brick_.world->history_form();
  for (int c = 0; c < form.length; ++c)
    at.list->history_of(at.k)[c * kBatch] = form.sign(c, is_swapped) * history[c];
}

template class HistoryCarry<2>;
template class HistoryCarry<3>;

}  // namespace barchan
