#include <barchan/core/brick/checkpoint.hpp>

#include <algorithm>
#include <unordered_map>

#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/measure.hpp>
#include <barchan/core/particles/fields.hpp>
#include <barchan/core/particles/row_record.hpp>

namespace barchan {
namespace {

template <int Dim>
void save_particles(const ParticleStore<Dim>& store, CheckpointShare& share) {
  const std::int32_t n = store.num_owned;
  for_each_field<Dim>([&]<class T>(const Field<Dim, T>& field) {
    if (!field.array.is_in(store)) return;
    std::vector<T>& column = share.*field.saved;
    const auto width = static_cast<std::size_t>(field.width);
    column.resize(static_cast<std::size_t>(n) * width);
    for (std::int32_t row = 0; row < n; ++row)
      std::copy_n(field.of(store, row), width,
                  column.data() + static_cast<std::size_t>(row) * width);
  });
  const std::size_t carried =
      static_cast<std::size_t>(n) * static_cast<std::size_t>(store.num_carried);
  share.carried.assign(store.carried.begin(),
                       store.carried.begin() + static_cast<std::ptrdiff_t>(carried));
}

/// @pre room for the rows, zeros in them
template <int Dim>
void restore_particles(const CheckpointShare& share, ParticleStore<Dim>& store) {
  const std::int32_t n = store.num_owned;
  for_each_field<Dim>([&]<class T>(const Field<Dim, T>& field) {
    const std::vector<T>& column = share.*field.saved;
    auto& values = store.*field.array.values;
    if (field.array.is_of_heat && !store.has_heat) return;
    if (field.array.is_optional) {
      if (column.empty()) return;
      values.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(field.array.width), T{});
    }
    const auto width = static_cast<std::size_t>(field.width);
    for (std::int32_t row = 0; row < n; ++row)
      std::copy_n(column.data() + static_cast<std::size_t>(row) * width, width,
                  field.of(store, row));
  });
  std::copy(share.carried.begin(), share.carried.end(), store.carried.begin());
  for (std::int32_t row = 0; row < n; ++row) store.set_radius(row, store.radius(row));
}

/// Of squared distances and of distances: what may hold, and a little more for rounding.
constexpr double kTouching = 1.0 + 1e-9;

/// Those that may hold. Others lose their history in the next step anyway, and may be farther apart
/// than the lists of a restart reach.
template <int Dim>
void save_contacts(const Brick<Dim>& brick, const PairList& list, const PairBlock& block,
                   CheckpointShare& share) {
  const ParticleStore<Dim>& store = brick.store;
  const PeriodicBox& box = brick.world->grid.box();
  block.for_each_candidate(list, [&](std::size_t k, const double* numbers) {
    bool has_history = false;
    for (int c = 0; c < list.history_length; ++c)
      has_history = has_history || numbers[c * kBatch] != 0.0;
    if (!has_history) return;
    const std::int32_t i = list.i[k], j = list.j[k];
    const double reach = store.radius(i) + store.radius(j) + brick.world->range;
    if (distance2<Dim>(box, store.x(i), store.x(j)) > kTouching * reach * reach) return;
    for (const std::int32_t end : {i, j})
      share.contact_ids.push_back(store.id[static_cast<std::size_t>(end)]);
    for (int c = 0; c < list.history_length; ++c)
      share.contact_springs.push_back(numbers[c * kBatch]);
  });
}

template <int Dim>
void save_walls(const Brick<Dim>& brick, CheckpointShare& share) {
  const World<Dim>& world = *brick.world;
  const ParticleStore<Dim>& store = brick.store;
  for (const WallContact<Dim>& c : brick.walls.list()) {
    const auto w = static_cast<std::size_t>(c.wall);
    if (!has_history(c) ||
        world.wall_shapes[w].foot(world.walls[w].point, c.image, store.x(c.row)).distance >
            kTouching * (store.radius(c.row) + world.range))
      continue;
    share.wall_contact_ids.push_back(store.id[static_cast<std::size_t>(c.row)]);
    share.wall_contact_walls.push_back(c.wall);
    share.wall_contact_images.insert(share.wall_contact_images.end(), c.image.begin(),
                                     c.image.end());
    share.wall_contact_springs.insert(share.wall_contact_springs.end(), c.history,
                                      c.history + world.history_form().length);
  }
}

template <int Dim>
void save_bonds(const Brick<Dim>& brick, CheckpointShare& share) {
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(brick.bonds.bonds().size()); ++b) {
    if (!brick.counts_bond(b)) continue;
    const Bond<Dim>& bond = brick.bonds.bonds()[static_cast<std::size_t>(b)];
    share.bond_ids.insert(share.bond_ids.end(), {bond.id_a, bond.id_b});
    share.bond_laws.push_back(bond.law);
    share.bond_lengths.push_back(bond.length);
    share.bond_states.insert(share.bond_states.end(), bond.state.begin(), bond.state.end());
  }
}

using RowOfId = std::unordered_map<std::int64_t, std::int32_t>;

template <int Dim>
void queue_contacts(const History& form, const CheckpointShare& share, const RowOfId& row_of,
                    HistoryCarry<Dim>& carry) {
  const auto length = static_cast<std::size_t>(form.length);
  for (std::size_t k = 0; k < share.contact_ids.size() / 2; ++k) {
    const std::int64_t ends[2] = {share.contact_ids[2 * k], share.contact_ids[2 * k + 1]};
    const auto first = row_of.find(ends[0]), second = row_of.find(ends[1]);
    if (first == row_of.end() && second == row_of.end()) continue;
    const bool is_second = first == row_of.end();
    double* numbers =
        carry.add_contact(is_second ? second->second : first->second, ends[is_second ? 0 : 1]);
    for (int c = 0; c < form.length; ++c)
      numbers[c] =
          form.sign(c, is_second) * share.contact_springs[k * length + static_cast<std::size_t>(c)];
  }
}

template <int Dim>
void queue_walls(const History& form, const CheckpointShare& share, const RowOfId& row_of,
                 HistoryCarry<Dim>& carry) {
  const auto length = static_cast<std::size_t>(form.length);
  for (std::size_t k = 0; k < share.wall_contact_ids.size(); ++k) {
    const auto row = row_of.find(share.wall_contact_ids[k]);
    if (row == row_of.end()) continue;
    WallContact<Dim> c{row->second, share.wall_contact_walls[k], {}, {}};
    std::copy_n(share.wall_contact_images.data() + k * c.image.size(), c.image.size(),
                c.image.begin());
    std::copy_n(share.wall_contact_springs.data() + k * length, length, c.history);
    carry.add_wall_contact(c);
  }
}

template <int Dim>
void take_bonds(const CheckpointShare& share, const RowOfId& row_of, BondSet<Dim>& bonds) {
  for (std::size_t k = 0; k < share.bond_laws.size(); ++k) {
    const std::int64_t a = share.bond_ids[2 * k], b = share.bond_ids[2 * k + 1];
    if (!row_of.contains(a) && !row_of.contains(b)) continue;
    Bond<Dim> bond{a, b, share.bond_laws[k], share.bond_lengths[k], {}};
    std::copy_n(share.bond_states.data() + k * Bond<Dim>::kState, std::size_t{Bond<Dim>::kState},
                bond.state.data());
    bonds.add(bond);
  }
}

}  // namespace

template <int Dim>
void save(const Brick<Dim>& brick, CheckpointShare& share) {
  share.clear();
  save_particles(brick.store, share);
  brick.for_each_counted([&](const PairList& list, const PairBlock& block) {
    save_contacts(brick, list, block, share);
  });
  save_walls(brick, share);
  save_bonds(brick, share);
  share.outruns.push_back(
      std::max(brick.outrun, outrun_share(distance2_of_last_step(brick), brick.skin)));
  share.totals.push_back(brick.bonds.num_broken());
  const auto put = [&](ExactSum sum) {
    sum.carry();
    share.totals.insert(share.totals.end(), sum.digits().begin(), sum.digits().end());
  };
  for (std::size_t w = 0; w < brick.world->walls.size(); ++w)
    put(w < brick.wall_sums.size() ? brick.wall_sums[w].work : ExactSum());
  for (const ExactSum& sum : brick.works.sums) put(sum);
}

template <int Dim>
void restore(Brick<Dim>& brick, Rebuild<Dim>& rebuild, const Placement<Dim>& at,
             const CheckpointShare& share) {
  const auto n = static_cast<std::int32_t>(share.ids.size());
  rebuild.own(at, n);
  ParticleStore<Dim>& store = brick.store;
  for (std::int32_t i = 0; i < n; ++i) RowRecord<Dim>().put(store, i);
  restore_particles(share, store);
  RowOfId row_of;
  for (std::int32_t i = 0; i < n; ++i) {
    const auto row = static_cast<std::size_t>(i);
    store.key[row] = brick.world->grid.key(store.x(i));
    if (!row_of.emplace(store.id[row], i).second) {
      throw RunError("the checkpoint has particle " + std::to_string(store.id[row]) +
                     " twice: take another one");
    }
  }
  for (const double outrun : share.outruns) brick.outrun = std::max(brick.outrun, outrun);
  const History& form = brick.world->history_form();
  queue_contacts(form, share, row_of, rebuild.carry());
  queue_walls(form, share, row_of, rebuild.carry());
  take_bonds(share, row_of, brick.bonds);
}

template void save(const Brick<2>&, CheckpointShare&);
template void save(const Brick<3>&, CheckpointShare&);
template void restore(Brick<2>&, Rebuild<2>&, const Placement<2>&, const CheckpointShare&);
template void restore(Brick<3>&, Rebuild<3>&, const Placement<3>&, const CheckpointShare&);

}  // namespace barchan
