#include <algorithm>
#include <utility>

#include <barchan/core/base/bytes.hpp>
#include <barchan/core/base/stopwatch.hpp>
#include <barchan/core/brick/lane.hpp>
#include <barchan/core/particles/row_order.hpp>

// Ownership and order: who leaves, who arrives, rows by cells, ghosts.

namespace barchan {
template <int Dim>
int Lane<Dim>::direction_of(std::int64_t key, std::int64_t key_before) const {
  const std::int64_t slab_size = world_->grid.slab_size();
  if (key >= slab_begin_ * slab_size && key < slab_end_ * slab_size) return 0;
  const int slab = static_cast<int>(key / slab_size);
  if (!band(Side::Left).exists || !band(Side::Right).exists)
    return band(Side::Right).exists ? 2 : 1;
  if (!world_->grid.is_periodic(0)) return slab >= slab_end_ ? 2 : 1;
  // It has gone the shorter way from where it was, maybe around an end of the box. From the new
  // strip the shorter way may be the wrong one: cuts move by up to a strip at a time.
  const int n = world_->grid.num_slabs(), before = static_cast<int>(key_before / slab_size);
  const int way = slab - before;
  const int unwrapped = 2 * way > n ? slab - n : 2 * way < -n ? slab + n : slab;
  return unwrapped >= slab_end_ ? 2 : 1;
}

template <int Dim>
bool Lane<Dim>::computes_bond(std::int32_t bond) const {
  if (!band(Side::Right).returns) return true;
  const std::int32_t first_right_ghost = store_.ghost_begin(Side::Right);
  return bonds_.end_a(bond) < first_right_ghost && bonds_.end_b(bond) < first_right_ghost;
}

template <int Dim>
std::pair<bool, bool> Lane<Dim>::bond_leaves(std::int32_t bond) const {
  std::pair<bool, bool> leaves{false, false};
  for (const std::int32_t end : {bonds_.end_a(bond), bonds_.end_b(bond)}) {
    if (!store_.is_owned(end)) continue;
    const std::int8_t goes = goes_[static_cast<std::size_t>(end)];
    leaves.first = leaves.first || goes == 1;
    leaves.second = leaves.second || goes == 2;
  }
  return leaves;
}

template <int Dim>
void Lane<Dim>::begin_rebuild(int slab_begin, int slab_end, std::vector<std::byte>& to_left,
                              std::vector<std::byte>& to_right) {
  slab_begin_ = slab_begin;
  slab_end_ = slab_end;
  outrun_ = outrun_share(distance2_of_last_step(), lists_skin_);
  const std::int32_t n = store_.num_owned;
  goes_.assign(static_cast<std::size_t>(n), 0);
  std::vector<std::int32_t> number(static_cast<std::size_t>(n), 0);
  std::array<Migration<Dim>, 2> out;
  for (Migration<Dim>& m : out) m.contacts.length = history_form().length;
  for (std::int32_t i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::int64_t key_before = std::exchange(store_.key[at], world_->grid.key(store_.x(i)));
    goes_[at] = static_cast<std::int8_t>(direction_of(store_.key[at], key_before));
    if (is_removed(i) || loses(Loss::Particle)) goes_[at] = kGone;
    if (goes_[at] == 0 || goes_[at] == kGone) continue;
    auto& leavers = out[static_cast<std::size_t>(goes_[at] - 1)].particles;
    number[at] = static_cast<std::int32_t>(leavers.size());
    leavers.emplace_back().take(store_, i);
  }

  loose_.clear(history_form().length);
  collect_history(out, number);
  old_walls_.clear();
  for (const WallContact<Dim>& c : walls_.list()) {
    const auto at = static_cast<std::size_t>(c.row);
    if (goes_[at] == kGone) continue;
    if (has_history(c)) --imbalance_.wall_contacts;
    if (goes_[at] == 0) {
      old_walls_.push_back(c);
      continue;
    }
    WallRecord<Dim> w{number[at], c.wall, c.image, {}};
    std::copy_n(c.history, int{kLongestHistory<Dim>}, w.history);
    out[static_cast<std::size_t>(goes_[at] - 1)].walls.push_back(w);
  }
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(bonds_.bonds().size()); ++b) {
    if (bonds_.is_broken(b)) continue;
    if (counts_bond(b)) --imbalance_.bonds;
    if (loses(Loss::Bond)) bonds_.cancel(b);
    const auto [left, right] = bond_leaves(b);
    const BondRecord<Dim> record{bonds_.bonds()[static_cast<std::size_t>(b)],
                                 static_cast<std::uint8_t>(computes_bond(b))};
    if (left) out[0].bonds.push_back(record);
    if (right) out[1].bonds.push_back(record);
  }
  bonds_.drop_broken();
  encode(out[0], to_left);
  encode(out[1], to_right);
}

template <int Dim>
void Lane<Dim>::absorb(std::span<const std::byte> message) {
  if (message.empty()) return;
  auto [particles, contacts, walls, bonds] =
      decode_migration(message, *world_, slab_begin_, slab_end_);

  // Arrivals follow the source rows of begin_rebuild; ghosts and waste rows are no longer needed.
  const auto first = static_cast<std::int32_t>(goes_.size());
  const std::int32_t end = first + static_cast<std::int32_t>(particles.size());
  store_.resize_rows(static_cast<std::size_t>(std::max(end + 2, store_.size())));
  goes_.resize(static_cast<std::size_t>(end), 0);
  for (std::size_t p = 0; p < particles.size(); ++p)
    particles[p].put(store_, first + static_cast<std::int32_t>(p));
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const LooseContact& c = contacts.rows[k];
    std::copy_n(contacts.history(k), contacts.length, loose_.push({first + c.handle, c.partner}));
  }
  for (const auto& w : walls) {
    WallContact<Dim> c{first + w.number, w.wall, w.image, {}};
    std::copy_n(w.history, int{kLongestHistory<Dim>}, c.history);
    old_walls_.push_back(c);
  }
  for (const auto& b : bonds) bonds_.add(b.bond, b.is_current != 0);
}

template <int Dim>
void Lane<Dim>::order() {
  // Counting sort by cell. Within a cell any order will do.
  const std::int64_t first_key = slab_begin_ * world_->grid.slab_size();
  const auto num_cells =
      static_cast<std::size_t>((slab_end_ - slab_begin_) * world_->grid.slab_size());
  std::vector<std::int32_t> start(num_cells + 1, 0);
  std::int32_t stays = 0;
  for (std::size_t row = 0; row < goes_.size(); ++row) {
    if (goes_[row] != 0) continue;
    ++start[static_cast<std::size_t>(store_.key[row] - first_key) + 1];
    ++stays;
  }
  for (std::size_t c = 0; c < num_cells; ++c) start[c + 1] += start[c];
  std::vector<std::int32_t> source(static_cast<std::size_t>(stays));
  source.reserve(goes_.size());
  std::vector<std::int32_t> next(start.begin(), start.end() - 1);
  for (std::size_t row = 0; row < goes_.size(); ++row) {
    if (goes_[row] != 0) continue;
    const auto cell = static_cast<std::size_t>(store_.key[row] - first_key);
    source[static_cast<std::size_t>(next[cell]++)] = static_cast<std::int32_t>(row);
  }
  new_row_.assign(goes_.size(), -1);
  for (std::int32_t i = 0; i < stays; ++i)
    new_row_[static_cast<std::size_t>(source[static_cast<std::size_t>(i)])] = i;
  for (std::size_t row = 0; row < goes_.size(); ++row) {
    if (goes_[row] != 0) source.push_back(static_cast<std::int32_t>(row));
  }
  if (!store_.external.empty()) store_.external.resize(goes_.size() * L::kForce, 0.0);
  move_rows(store_, source);
  if (!store_.external.empty()) store_.external.resize(static_cast<std::size_t>(stays) * L::kForce);
  store_.num_owned = stays;
  store_.num_ghosts = {};
  store_.resize_for_ghosts(world_->grain.rounder());
  cells_.index(world_->grid, store_, {0, stays}, slab_begin_, slab_end_);
  resize_with_room(store_.reference, static_cast<std::size_t>(stays) * Dim);
  double* reference = store_.reference.data();
  for (std::int32_t i = 0; i < stays; ++i) {
    for (int c = 0; c < Dim; ++c) *reference++ = store_.x(i)[c];
  }
  lists_skin_ = world_->skin;
  list_bonded();
}

template <int Dim>
void Lane<Dim>::pack_ghosts(Side side, std::vector<std::byte>& message) const {
  const std::int64_t slab_size = world_->grid.slab_size();
  const std::int32_t begin = side == Side::Left ? 0 : cells_.first_row(slab_end_ - 1, slab_size);
  const std::int32_t end =
      side == Side::Left ? cells_.first_row(slab_begin_ + 1, slab_size) : store_.num_owned;
  std::vector<RowRecord<Dim>> records(static_cast<std::size_t>(end - begin));
  for (std::int32_t i = begin; i < end; ++i) {
    RowRecord<Dim>& record = records[static_cast<std::size_t>(i - begin)];
    record.take(store_, i);
    record.forget_optional();
  }
  message.clear();
  ByteWriter(message).put_counted(records);
}

template <int Dim>
void Lane<Dim>::take_ghosts(std::span<const std::byte> left, std::span<const std::byte> right) {
  const int num_slabs = world_->grid.num_slabs();
  const std::array<int, 2> slabs{(slab_begin_ - 1 + num_slabs) % num_slabs, slab_end_ % num_slabs};
  std::array<std::vector<RowRecord<Dim>>, 2> ghosts;
  for (const Side side : kSides) {
    if (!band(side).exists) continue;
    ghosts[index_of(side)] =
        decode_ghosts(side == Side::Left ? left : right, *world_, slabs[index_of(side)]);
    store_.num_ghosts[index_of(side)] = static_cast<std::int32_t>(ghosts[index_of(side)].size());
  }
  store_.resize_for_ghosts(world_->grain.rounder());
  for (const Side side : kSides) {
    if (!band(side).exists) continue;
    std::int32_t row = store_.ghost_begin(side);
    const std::int32_t begin = row;
    for (const RowRecord<Dim>& record : ghosts[index_of(side)]) record.put(store_, row++);
    band(side).ghost_cells.index(world_->grid, store_, {begin, row}, slabs[index_of(side)],
                                 slabs[index_of(side)] + 1);
    const Stopwatch watch(search_seconds_.rebuild);
    list_across(side);
  }
}

template class Lane<2>;
template class Lane<3>;

}  // namespace barchan
