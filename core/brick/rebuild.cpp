#include <barchan/core/brick/rebuild.hpp>

#include <barchan/core/base/bytes.hpp>
#include <barchan/core/brick/measure.hpp>
#include <barchan/core/brick/step.hpp>
#include <barchan/core/particles/row_order.hpp>
#include <barchan/core/particles/row_particle.hpp>

namespace barchan {

template <int Dim>
void Rebuild<Dim>::own(int slab_begin, int slab_end, std::int32_t count) {
  brick_.slab_begin = slab_begin;
  brick_.slab_end = slab_end;
  brick_.store.num_owned = count;
  brick_.store.num_ghosts = {};
  brick_.store.resize_for_ghosts(brick_.world->grain.rounder());
  leavers_.way.assign(static_cast<std::size_t>(count), Leavers::Stays);
  carry_.clear();
}

template <int Dim>
void Rebuild<Dim>::seed(int slab_begin, int slab_end, std::span<const ParticleData> particles,
                        std::span<const BondData> bonds, std::span<const double> bond_lengths,
                        std::span<const char> is_bonded) {
  own(slab_begin, slab_end, static_cast<std::int32_t>(particles.size()));
  ParticleStore<Dim>& store = brick_.store;
  const Grid<Dim>& grid = brick_.world->grid;
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    const auto at = static_cast<std::size_t>(i);
    set_particle(store, i, particles[at], is_bonded[at] != 0);
    grid.wrap(store.x(i));
    store.key[at] = grid.key(store.x(i));
  }
  for (std::size_t b = 0; b < bonds.size(); ++b)
    brick_.bonds.add(bond_of<Dim>(bonds[b], bond_lengths[b]));
}

template <int Dim>
LinkCounts Rebuild<Dim>::remove(std::span<const std::int64_t> ids) {
  leavers_.removed.assign(ids.begin(), ids.end());
  const auto is_removed = [this](std::int32_t row) {
    return leavers_.is_removed(brick_.store.id[static_cast<std::size_t>(row)]);
  };
  if (brick_.world->accounts) {
    for (std::int32_t i = 0; i < brick_.store.num_owned; ++i) {
      if (is_removed(i)) brick_.works[EnergyWorks::Departed].add(kinetic_energy(brick_.store, i));
    }
  }
  LinkCounts gone;
  brick_.for_each_counted([&](const PairList& list, const PairBlock& block) {
    block.for_each_worked_on(list, [&](std::size_t k, std::int32_t i, std::int32_t j) {
      const bool goes =
          list.has_history(static_cast<std::int64_t>(k)) && (is_removed(i) || is_removed(j));
      gone.contacts += goes ? 1 : 0;
    });
  });
  for (const WallContact<Dim>& c : brick_.walls.list())
    gone.wall_contacts += has_history(c) && is_removed(c.row) ? 1 : 0;
  BondSet<Dim>& bonds = brick_.bonds;
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(bonds.bonds().size()); ++b) {
    if (!is_removed(bonds.end_a(b)) && !is_removed(bonds.end_b(b))) continue;
    gone.bonds += brick_.counts_bond(b) ? 1 : 0;
    bonds.cancel(b);
  }
  return gone;
}

template <int Dim>
Leavers::Way Rebuild<Dim>::way_of(std::int64_t key, std::int64_t key_before) const {
  const Grid<Dim>& grid = brick_.world->grid;
  const std::int64_t slab_size = grid.slab_size();
  if (key >= brick_.slab_begin * slab_size && key < brick_.slab_end * slab_size)
    return Leavers::Stays;
  const int slab = static_cast<int>(key / slab_size);
  const bool has_left = brick_.band(Side::Left).exists, has_right = brick_.band(Side::Right).exists;
  if (!has_left || !has_right) return has_right ? Leavers::ToRight : Leavers::ToLeft;
  if (!grid.is_periodic(0)) return slab >= brick_.slab_end ? Leavers::ToRight : Leavers::ToLeft;
  // It has gone the shorter way from where it was, maybe around an end of the box. From the new
  // strip the shorter way may be the wrong one: cuts move by up to a strip at a time.
  const int n = grid.num_slabs(), before = static_cast<int>(key_before / slab_size);
  const int way = slab - before;
  const int unwrapped = 2 * way > n ? slab - n : 2 * way < -n ? slab + n : slab;
  return unwrapped >= brick_.slab_end ? Leavers::ToRight : Leavers::ToLeft;
}

template <int Dim>
bool Rebuild<Dim>::computes_bond(std::int32_t bond) const {
  if (!brick_.band(Side::Right).returns) return true;
  const std::int32_t first_right_ghost = brick_.store.ghost_begin(Side::Right);
  return brick_.bonds.end_a(bond) < first_right_ghost &&
         brick_.bonds.end_b(bond) < first_right_ghost;
}

template <int Dim>
std::pair<bool, bool> Rebuild<Dim>::bond_leaves(std::int32_t bond) const {
  std::pair<bool, bool> leaves{false, false};
  for (const std::int32_t end : {brick_.bonds.end_a(bond), brick_.bonds.end_b(bond)}) {
    if (!brick_.store.is_owned(end)) continue;
    leaves.first = leaves.first || leavers_.of(end) == Leavers::ToLeft;
    leaves.second = leaves.second || leavers_.of(end) == Leavers::ToRight;
  }
  return leaves;
}

template <int Dim>
void Rebuild<Dim>::begin(int slab_begin, int slab_end, std::vector<std::byte>& to_left,
                         std::vector<std::byte>& to_right) {
  brick_.slab_begin = slab_begin;
  brick_.slab_end = slab_end;
  brick_.outrun = outrun_share(distance2_of_last_step(brick_), brick_.skin);
  std::array<Migration<Dim>, 2> out;
  find_leavers(out);
  carry_.collect(leavers_, out);
  collect_bonds(out);
  encode(out[0], to_left);
  encode(out[1], to_right);
}

template <int Dim>
void Rebuild<Dim>::find_leavers(std::array<Migration<Dim>, 2>& out) {
  ParticleStore<Dim>& store = brick_.store;
  const std::int32_t n = store.num_owned;
  leavers_.way.assign(static_cast<std::size_t>(n), Leavers::Stays);
  leavers_.number.assign(static_cast<std::size_t>(n), 0);
  for (std::int32_t i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::int64_t key_before =
        std::exchange(store.key[at], brick_.world->grid.key(store.x(i)));
    leavers_.way[at] = way_of(store.key[at], key_before);
    if (leavers_.is_removed(store.id[at]) || carry_.loses(Loss::Particle))
      leavers_.way[at] = Leavers::Gone;
    if (!leavers_.leaves(i)) continue;
    auto& particles = out[static_cast<std::size_t>(leavers_.way[at] - 1)].particles;
    leavers_.number[at] = static_cast<std::int32_t>(particles.size());
    particles.emplace_back().take(store, i);
  }
}

template <int Dim>
void Rebuild<Dim>::collect_bonds(std::array<Migration<Dim>, 2>& out) {
  BondSet<Dim>& bonds = brick_.bonds;
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(bonds.bonds().size()); ++b) {
    if (bonds.is_broken(b)) continue;
    if (brick_.counts_bond(b)) --carry_.imbalance().bonds;
    if (carry_.loses(Loss::Bond)) bonds.cancel(b);
    const auto [left, right] = bond_leaves(b);
    const BondRecord<Dim> record{bonds.bonds()[static_cast<std::size_t>(b)],
                                 static_cast<std::uint8_t>(computes_bond(b))};
    if (left) out[0].bonds.push_back(record);
    if (right) out[1].bonds.push_back(record);
  }
  bonds.drop_broken();
}

template <int Dim>
void Rebuild<Dim>::absorb(std::span<const std::byte> message) {
  if (message.empty()) return;
  const Migration<Dim> in =
      decode_migration(message, *brick_.world, brick_.slab_begin, brick_.slab_end);
  // Arrivals follow the source rows of begin; ghosts and waste rows are no longer needed.
  ParticleStore<Dim>& store = brick_.store;
  const auto first = static_cast<std::int32_t>(leavers_.way.size());
  const std::int32_t end = first + static_cast<std::int32_t>(in.particles.size());
  store.resize_rows(static_cast<std::size_t>(std::max(end + 2, store.size())));
  leavers_.way.resize(static_cast<std::size_t>(end), Leavers::Stays);
  for (std::size_t p = 0; p < in.particles.size(); ++p)
    in.particles[p].put(store, first + static_cast<std::int32_t>(p));
  for (std::size_t k = 0; k < in.contacts.size(); ++k) {
    const LooseContact& c = in.contacts.rows[k];
    std::copy_n(in.contacts.history(k), in.contacts.length,
                carry_.add_contact(first + c.handle, c.partner));
  }
  for (const auto& w : in.walls) {
    WallContact<Dim> c{first + w.number, w.wall, w.image, {}};
    std::copy_n(w.history, int{kLongestHistory<Dim>}, c.history);
    carry_.add_wall_contact(c);
  }
  for (const auto& b : in.bonds) brick_.bonds.add(b.bond, b.is_current != 0);
}

template <int Dim>
void Rebuild<Dim>::take_in(std::span<const ParticleData> newcomers) {
  ParticleStore<Dim>& store = brick_.store;
  const Grid<Dim>& grid = brick_.world->grid;
  for (const ParticleData& p : newcomers) {
    double x[3] = {p.position[0], p.position[1], p.position[2]};
    grid.wrap(x);
    const int slab = grid.coordinate(x, 0);
    if (slab < brick_.slab_begin || slab >= brick_.slab_end) continue;
    const auto row = static_cast<std::int32_t>(leavers_.way.size());
    store.resize_rows(static_cast<std::size_t>(std::max(row + 3, store.size())));
    leavers_.way.push_back(Leavers::Stays);
    set_particle(store, row, p, false);
    grid.wrap(store.x(row));
    store.key[static_cast<std::size_t>(row)] = grid.key(store.x(row));
  }
}

/// Counting sort by cell; within a cell any order will do. @return of every row where it comes
/// from, then those that have left
template <int Dim>
std::vector<std::int32_t> Rebuild<Dim>::sources() {
  const std::vector<std::int8_t>& way = leavers_.way;
  const std::int64_t slab_size = brick_.world->grid.slab_size(),
                     first_key = brick_.slab_begin * slab_size;
  const auto cell_of = [&](std::size_t row) {
    return static_cast<std::size_t>(brick_.store.key[row] - first_key);
  };
  std::vector<std::int32_t> next(
      static_cast<std::size_t>((brick_.slab_end - brick_.slab_begin) * slab_size) + 1, 0);
  std::int32_t stays = 0;
  for (std::size_t row = 0; row < way.size(); ++row) {
    if (way[row] != Leavers::Stays) continue;
    ++next[cell_of(row) + 1];
    ++stays;
  }
  for (std::size_t c = 0; c + 1 < next.size(); ++c) next[c + 1] += next[c];
  std::vector<std::int32_t> source(static_cast<std::size_t>(stays));
  source.reserve(way.size());
  new_row_.assign(way.size(), -1);
  for (std::size_t row = 0; row < way.size(); ++row) {
    if (way[row] != Leavers::Stays) continue;
    new_row_[row] = next[cell_of(row)]++;
    source[static_cast<std::size_t>(new_row_[row])] = static_cast<std::int32_t>(row);
  }
  for (std::size_t row = 0; row < way.size(); ++row) {
    if (way[row] != Leavers::Stays) source.push_back(static_cast<std::int32_t>(row));
  }
  brick_.store.num_owned = stays;
  return source;
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
  brick_.cells.index(world.grid, store, {0, store.num_owned}, brick_.slab_begin, brick_.slab_end);
  resize_with_room(store.reference, stays * Dim);
  double* reference = store.reference.data();
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    for (int c = 0; c < Dim; ++c) *reference++ = store.x(i)[c];
  }
  brick_.skin = world.skin;
  lists_.list_bonded();
}

template <int Dim>
void Rebuild<Dim>::pack_ghosts(Side side, std::vector<std::byte>& message) const {
  const std::int64_t slab_size = brick_.world->grid.slab_size();
  const Rows rows =
      side == Side::Left
          ? Rows{0, brick_.cells.first_row(brick_.slab_begin + 1, slab_size)}
          : Rows{brick_.cells.first_row(brick_.slab_end - 1, slab_size), brick_.store.num_owned};
  std::vector<RowRecord<Dim>> records(static_cast<std::size_t>(rows.end - rows.begin));
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    RowRecord<Dim>& record = records[static_cast<std::size_t>(i - rows.begin)];
    record.take(brick_.store, i);
    record.forget_optional();
  }
  message.clear();
  ByteWriter(message).put_counted(records);
}

template <int Dim>
void Rebuild<Dim>::take_ghosts(std::span<const std::byte> left, std::span<const std::byte> right) {
  const World<Dim>& world = *brick_.world;
  ParticleStore<Dim>& store = brick_.store;
  const int num_slabs = world.grid.num_slabs();
  const std::array<int, 2> slabs{(brick_.slab_begin - 1 + num_slabs) % num_slabs,
                                 brick_.slab_end % num_slabs};
  std::array<std::vector<RowRecord<Dim>>, 2> records;
  for (const Side side : kSides) {
    if (!brick_.band(side).exists) continue;
    const auto s = index_of(side);
    records[s] = decode_ghosts(side == Side::Left ? left : right, world, slabs[s]);
    store.num_ghosts[s] = static_cast<std::int32_t>(records[s].size());
  }
  store.resize_for_ghosts(world.grain.rounder());
  for (const Side side : kSides) {
    Band& band = brick_.band(side);
    if (!band.exists) continue;
    const int slab = slabs[index_of(side)];
    const Rows ghosts = store.ghosts(side);
    std::int32_t row = ghosts.begin;
    for (const RowRecord<Dim>& record : records[index_of(side)]) record.put(store, row++);
    band.ghost_cells.index(world.grid, store, ghosts, slab, slab + 1);
    lists_.list_across(side);
  }
}

template <int Dim>
void Rebuild<Dim>::restore_history() {
  const World<Dim>& world = *brick_.world;
  brick_.walls.search(brick_.store, world.wall_view(), world.skin + world.range);
  carry_.put_back(new_row_);
  BondSet<Dim>& bonds = brick_.bonds;
  bonds.resolve(brick_.store);
  bonds.require_short(world.grid, brick_.store);
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(bonds.bonds().size()); ++b)
    carry_.imbalance().bonds += brick_.counts_bond(b) ? 1 : 0;
  leavers_.removed.clear();
  find_quick(brick_);
}

template class Rebuild<2>;
template class Rebuild<3>;

}  // namespace barchan
