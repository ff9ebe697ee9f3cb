#include <barchan/core/brick/rebuild.hpp>

#include <cmath>
#include <string>

#include <barchan/core/base/bytes.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/cell_order.hpp>
#include <barchan/core/brick/measure.hpp>
#include <barchan/core/brick/step.hpp>
#include <barchan/core/particles/row_order.hpp>
#include <barchan/core/particles/row_particle.hpp>

namespace barchan {
namespace {

/// Newcomers of a program may not say how warm they are.
ParticleData with_temperature(ParticleData p, const HeatTable& heat) {
  if (std::isnan(p.temperature)) p.temperature = heat.start;
  return p;
}

}  // namespace

template <int Dim>
void Rebuild<Dim>::own(const Placement<Dim>& at, std::int32_t count) {
  brick_.place(at);
  brick_.store.num_owned = count;
  brick_.store.num_ghosts = {};
  brick_.store.resize_for_ghosts(brick_.world->grain.rounder(), brick_.world->heat.grain.rounder());
  leavers_.way.assign(static_cast<std::size_t>(count), Leavers::Stays);
  carry_.clear();
}

template <int Dim>
void Rebuild<Dim>::seed(const Placement<Dim>& at, std::span<const ParticleData> particles,
                        std::span<const BondData> bonds, std::span<const double> bond_lengths,
                        std::span<const char> is_bonded) {
  own(at, static_cast<std::int32_t>(particles.size()));
  ParticleStore<Dim>& store = brick_.store;
  const Grid<Dim>& grid = brick_.world->grid;
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    const auto row = static_cast<std::size_t>(i);
    set_particle(store, i, with_temperature(particles[row], brick_.world->heat),
                 is_bonded[row] != 0);
    grid.wrap(store.x(i));
    store.key[row] = grid.key(store.x(i));
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

/// Whether it went around an end of the box does not matter: each link says where it leads.
template <int Dim>
std::int8_t Rebuild<Dim>::way_of(const CellAt<Dim>& at, std::int64_t id) const {
  if (brick_.box.contains(at)) return Leavers::Stays;
  for (std::size_t n = 0; n < brick_.links.size(); ++n) {
    if (brick_.links[n].beyond.contains(at)) return static_cast<std::int8_t>(n);
  }
  throw RunError("particle " + std::to_string(id) +
                 " jumped over a whole brick: the time step is too long");
}

template <int Dim>
bool Rebuild<Dim>::computes_bond(std::int32_t bond) const {
  if (!brick_.band(Side::Right).returns) return true;
  const std::int32_t first_right_ghost = brick_.store.ghost_begin(Side::Right);
  return brick_.bonds.end_a(bond) < first_right_ghost &&
         brick_.bonds.end_b(bond) < first_right_ghost;
}

template <int Dim>
void Rebuild<Dim>::begin(const Placement<Dim>& at, std::span<std::vector<std::byte>> out) {
  brick_.place(at);
  brick_.outrun = outrun_share(distance2_of_last_step(brick_), brick_.skin);
  std::vector<Migration<Dim>> leaving(brick_.links.size());
  find_leavers(leaving);
  carry_.collect(leavers_, leaving);
  collect_bonds(leaving);
  for (std::size_t n = 0; n < leaving.size(); ++n) encode(leaving[n], out[n]);
}

template <int Dim>
void Rebuild<Dim>::find_leavers(std::vector<Migration<Dim>>& out) {
  ParticleStore<Dim>& store = brick_.store;
  const std::int32_t n = store.num_owned;
  leavers_.way.assign(static_cast<std::size_t>(n), Leavers::Stays);
  leavers_.number.assign(static_cast<std::size_t>(n), 0);
  for (std::int32_t i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const CellAt<Dim> cell = brick_.world->grid.cell(store.x(i));
    store.key[at] = brick_.world->grid.key(cell);
    const bool is_gone = leavers_.is_removed(store.id[at]) || carry_.loses(Loss::Particle);
    leavers_.way[at] = is_gone ? std::int8_t{Leavers::Gone} : way_of(cell, store.id[at]);
    if (!leavers_.leaves(i)) continue;
    Migration<Dim>& leaving = out[static_cast<std::size_t>(leavers_.way[at])];
    leavers_.number[at] = static_cast<std::int32_t>(leaving.particles.size());
    leaving.particles.emplace_back().take(store, i);
    const auto numbers = store.carried_by(i);
    leaving.carried.insert(leaving.carried.end(), numbers.begin(), numbers.end());
  }
}

template <int Dim>
void Rebuild<Dim>::collect_bonds(std::vector<Migration<Dim>>& out) {
  BondSet<Dim>& bonds = brick_.bonds;
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(bonds.bonds().size()); ++b) {
    if (bonds.is_broken(b)) continue;
    if (brick_.counts_bond(b)) --carry_.imbalance().bonds;
    if (carry_.loses(Loss::Bond)) bonds.cancel(b);
    const BondRecord<Dim> record{bonds.bonds()[static_cast<std::size_t>(b)],
                                 static_cast<std::uint8_t>(computes_bond(b))};
    const auto way = [&](std::int32_t end) {
      return brick_.store.is_owned(end) ? leavers_.of(end) : std::int8_t{Leavers::Stays};
    };
    const std::int8_t a = way(bonds.end_a(b)), z = way(bonds.end_b(b));
    if (a >= 0) out[static_cast<std::size_t>(a)].bonds.push_back(record);
    if (z >= 0 && z != a) out[static_cast<std::size_t>(z)].bonds.push_back(record);
  }
  bonds.drop_broken();
}

template <int Dim>
void Rebuild<Dim>::absorb(std::span<const std::byte> message) {
  if (message.empty()) return;
  const Migration<Dim> in = decode_migration(message, *brick_.world, brick_.box);
  // Arrivals follow the source rows of begin; ghosts and waste rows are no longer needed.
  ParticleStore<Dim>& store = brick_.store;
  const auto first = static_cast<std::int32_t>(leavers_.way.size());
  const std::int32_t end = first + static_cast<std::int32_t>(in.particles.size());
  store.resize_rows(static_cast<std::size_t>(std::max(end + 2, store.size())));
  leavers_.way.resize(static_cast<std::size_t>(end), Leavers::Stays);
  for (std::size_t p = 0; p < in.particles.size(); ++p)
    in.particles[p].put(store, first + static_cast<std::int32_t>(p));
  if (!in.carried.empty())
    std::copy(in.carried.begin(), in.carried.end(), store.carried_by(first).begin());
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
    if (!brick_.box.contains(grid.cell(x))) continue;
    const auto row = static_cast<std::int32_t>(leavers_.way.size());
    store.resize_rows(static_cast<std::size_t>(std::max(row + 3, store.size())));
    leavers_.way.push_back(Leavers::Stays);
    set_particle(store, row, with_temperature(p, brick_.world->heat), false);
    grid.wrap(store.x(row));
    store.key[static_cast<std::size_t>(row)] = grid.key(store.x(row));
  }
}

template <int Dim>
void Rebuild<Dim>::order() {
  const World<Dim>& world = *brick_.world;
  ParticleStore<Dim>& store = brick_.store;
  constexpr auto kForce = std::size_t{Layout<Dim>::kForce};
  CellOrder ordered = order_by_cells(brick_, leavers_.way);
  const auto stays = static_cast<std::size_t>(ordered.num_owned);
  if (!store.external.empty()) store.external.resize(ordered.source.size() * kForce, 0.0);
  store.num_owned = ordered.num_owned;
  brick_.num_rim = ordered.num_rim;
  new_row_ = std::move(ordered.new_row);
  move_rows(store, ordered.source);
  if (!store.external.empty()) store.external.resize(stays * kForce);
  store.num_ghosts = {};
  store.resize_for_ghosts(world.grain.rounder(), world.heat.grain.rounder());
  brick_.cells.cover(world.grid, brick_.box, store.num_owned);
  brick_.cells.add(world.grid, store, {0, store.num_owned});
  place_bands(brick_);
  find_runs(brick_);
  resize_with_room(store.reference, stays * Dim);
  double* reference = store.reference.data();
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    for (int c = 0; c < Dim; ++c) *reference++ = store.x(i)[c];
  }
  brick_.skin = world.skin;
  lists_.list_bonded();
}

template <int Dim>
void Rebuild<Dim>::pack_ghosts(int link, std::vector<std::byte>& message) const {
  encode_ghosts<Dim>(brick_.store, brick_.links[static_cast<std::size_t>(link)].runs, message);
}

template <int Dim>
void Rebuild<Dim>::take_ghosts(std::span<const std::span<const std::byte>> messages) {
  const World<Dim>& world = *brick_.world;
  ParticleStore<Dim>& store = brick_.store;
  std::vector<std::vector<RowRecord<Dim>>> records;
  store.num_ghosts = {};
  for (std::size_t n = 0; n < brick_.links.size(); ++n) {
    const BrickLink<Dim>& link = brick_.links[n];
    records.push_back(decode_ghosts(messages[n], world, link.takes));
    store.num_ghosts[index_of(link.side)] += static_cast<std::int32_t>(records[n].size());
  }
  store.resize_for_ghosts(world.grain.rounder(), world.heat.grain.rounder());
  std::int32_t row = store.ghost_begin(Side::Left);
  for (std::size_t n = 0; n < brick_.links.size(); ++n) {
    BrickLink<Dim>& link = brick_.links[n];
    link.ghosts.begin = row;
    for (const RowRecord<Dim>& record : records[n]) record.put(store, row++);
    link.ghosts.end = row;
    link.travel = 0.0;
    brick_.cells.add(world.grid, store, link.ghosts);
  }
  for (const Side side : kSides) {
    if (brick_.band(side).exists) lists_.list_across(side);
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
