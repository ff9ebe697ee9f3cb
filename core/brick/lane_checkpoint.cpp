#include <algorithm>
#include <unordered_map>

#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/lane.hpp>
#include <barchan/core/particles/row_record.hpp>
#include <barchan/core/particles/share.hpp>

// Saving a lane and bringing it back. What lies across a cut is saved on its right: the left band's
// pairs and bonds.

namespace barchan {
namespace {

template <int Dim>
void save_particles(const ParticleStore<Dim>& store, CheckpointShare& share) {
  const std::int32_t n = store.num_owned;
  for_each_field<Dim>([&]<class T>(const Field<Dim, T>& field) {
    if (field.array.is_optional && (store.*field.array.values).empty()) return;
    std::vector<T>& column = share.*field.saved;
    const auto width = static_cast<std::size_t>(field.width);
    column.resize(static_cast<std::size_t>(n) * width);
    for (std::int32_t row = 0; row < n; ++row)
      std::copy_n(field.of(store, row), width,
                  column.data() + static_cast<std::size_t>(row) * width);
  });
}

/// @pre room for the rows, zeros in them
template <int Dim>
void restore_particles(const CheckpointShare& share, ParticleStore<Dim>& store) {
  const std::int32_t n = store.num_owned;
  for_each_field<Dim>([&]<class T>(const Field<Dim, T>& field) {
    const std::vector<T>& column = share.*field.saved;
    auto& values = store.*field.array.values;
    if (field.array.is_optional) {
      if (column.empty()) return;
      values.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(field.array.width), T{});
    }
    const auto width = static_cast<std::size_t>(field.width);
    for (std::int32_t row = 0; row < n; ++row)
      std::copy_n(column.data() + static_cast<std::size_t>(row) * width, width,
                  field.of(store, row));
  });
}

/// Of squared distances and of distances: what touches, and a little more for rounding.
constexpr double kTouching = 1.0 + 1e-9;

/// Those that touch. Others lose their history in the next step anyway, and may be farther apart
/// than the lists of a restart reach.
template <int Dim>
void save_contacts(const PeriodicBox& box, const ParticleStore<Dim>& store, const PairList& list,
                   CheckpointShare& share) {
  for (std::int64_t k = 0; k < list.size(); ++k) {
    const double* numbers = list.history_of(k);
    if (!list.has_history(k)) continue;
    const std::int32_t i = list.i[static_cast<std::size_t>(k)],
                       j = list.j[static_cast<std::size_t>(k)];
    const double reach = store.radius(i) + store.radius(j);
    if (distance2<Dim>(box, store.x(i), store.x(j)) > kTouching * reach * reach) continue;
    for (const std::int32_t end : {i, j})
      share.contact_ids.push_back(store.id[static_cast<std::size_t>(end)]);
    for (int c = 0; c < list.history_length; ++c)
      share.contact_springs.push_back(numbers[c * kBatch]);
  }
}

}  // namespace

template <int Dim>
void Lane<Dim>::save(CheckpointShare& share) {
  share.clear();
  unpack_history();
  save_particles(store_, share);
  const PeriodicBox& box = world_->grid.box();
  save_contacts(box, store_, pairs_, share);
  if (band(Side::Left).exists) save_contacts(box, store_, band(Side::Left).across, share);

  for (const WallContact<Dim>& c : walls_.list()) {
    const auto w = static_cast<std::size_t>(c.wall);
    if (!has_history(c) ||
        world_->wall_shapes[w].foot(world_->walls[w].point, c.image, store_.x(c.row)).distance >
            kTouching * store_.radius(c.row))
      continue;
    share.wall_contact_ids.push_back(store_.id[static_cast<std::size_t>(c.row)]);
    share.wall_contact_walls.push_back(c.wall);
    share.wall_contact_images.insert(share.wall_contact_images.end(), c.image.begin(),
                                     c.image.end());
    share.wall_contact_springs.insert(share.wall_contact_springs.end(), c.history,
                                      c.history + history_form().length);
  }
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(bonds_.bonds().size()); ++b) {
    const bool is_right_hand =
        std::max(bonds_.end_a(b), bonds_.end_b(b)) < store_.ghost_begin(Side::Right);
    if (bonds_.is_broken(b) || !is_right_hand) continue;
    const Bond<Dim>& bond = bonds_.bonds()[static_cast<std::size_t>(b)];
    share.bond_ids.insert(share.bond_ids.end(), {bond.id_a, bond.id_b});
    share.bond_laws.push_back(bond.law);
    share.bond_lengths.push_back(bond.length);
    share.bond_states.insert(share.bond_states.end(), bond.state.begin(), bond.state.end());
  }
  share.outruns.push_back(std::max(outrun_, outrun_share(distance2_of_last_step(), lists_skin_)));
  share.totals.push_back(bonds_.num_broken());
  for (std::size_t w = 0; w < world_->walls.size(); ++w) {
    if (w < wall_sums_.size()) wall_sums_[w].work.carry();
    const auto digits = w < wall_sums_.size() ? wall_sums_[w].work.digits() : ExactSum::Digits{};
    share.totals.insert(share.totals.end(), digits.begin(), digits.end());
  }
}

template <int Dim>
void Lane<Dim>::restore(int slab_begin, int slab_end, const CheckpointShare& share) {
  slab_begin_ = slab_begin;
  slab_end_ = slab_end;
  const auto n = static_cast<std::int32_t>(share.ids.size());
  store_.num_owned = n;
  store_.num_ghosts = {};
  store_.resize_for_ghosts(world_->grain.rounder());
  goes_.assign(share.ids.size(), 0);
  std::unordered_map<std::int64_t, std::int32_t> row_of;
  for (std::int32_t i = 0; i < n; ++i) RowRecord<Dim>().put(store_, i);
  restore_particles(share, store_);
  for (std::int32_t i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    store_.key[at] = world_->grid.key(store_.x(i));
    if (!row_of.emplace(store_.id[at], i).second) {
      throw RunError("the checkpoint has particle " + std::to_string(store_.id[at]) +
                     " twice: take another one");
    }
  }
  for (const double outrun : share.outruns) outrun_ = std::max(outrun_, outrun);
  queue_links(share, row_of);
}

template <int Dim>
void Lane<Dim>::queue_links(const CheckpointShare& share,
                            const std::unordered_map<std::int64_t, std::int32_t>& row_of) {
  const History& form = history_form();
  const auto length = static_cast<std::size_t>(form.length);
  loose_.clear(form.length);
  for (std::size_t k = 0; k < share.contact_ids.size() / 2; ++k) {
    const std::int64_t ends[2] = {share.contact_ids[2 * k], share.contact_ids[2 * k + 1]};
    const auto first = row_of.find(ends[0]), second = row_of.find(ends[1]);
    if (first == row_of.end() && second == row_of.end()) continue;
    const bool is_second = first == row_of.end();
    double* numbers =
        loose_.push({is_second ? second->second : first->second, ends[is_second ? 0 : 1]});
    for (int c = 0; c < form.length; ++c)
      numbers[c] =
          form.sign(c, is_second) * share.contact_springs[k * length + static_cast<std::size_t>(c)];
  }
  old_walls_.clear();
  for (std::size_t k = 0; k < share.wall_contact_ids.size(); ++k) {
    const auto row = row_of.find(share.wall_contact_ids[k]);
    if (row == row_of.end()) continue;
    WallContact<Dim> c{row->second, share.wall_contact_walls[k], {}, {}};
    std::copy_n(share.wall_contact_images.data() + k * c.image.size(), c.image.size(),
                c.image.begin());
    std::copy_n(share.wall_contact_springs.data() + k * length, length, c.history);
    old_walls_.push_back(c);
  }
  for (std::size_t k = 0; k < share.bond_laws.size(); ++k) {
    if (!row_of.contains(share.bond_ids[2 * k]) && !row_of.contains(share.bond_ids[2 * k + 1]))
      continue;
    Bond<Dim> bond{share.bond_ids[2 * k],
                   share.bond_ids[2 * k + 1],
                   share.bond_laws[k],
                   share.bond_lengths[k],
                   {}};
    std::copy_n(share.bond_states.data() + k * Bond<Dim>::kState, std::size_t{Bond<Dim>::kState},
                bond.state.data());
    bonds_.add(bond);
  }
}

template void Lane<2>::save(CheckpointShare&);
template void Lane<3>::save(CheckpointShare&);
template void Lane<2>::restore(int, int, const CheckpointShare&);
template void Lane<3>::restore(int, int, const CheckpointShare&);
template void Lane<2>::queue_links(const CheckpointShare&,
                                   const std::unordered_map<std::int64_t, std::int32_t>&);
template void Lane<3>::queue_links(const CheckpointShare&,
                                   const std::unordered_map<std::int64_t, std::int32_t>&);

}  // namespace barchan
