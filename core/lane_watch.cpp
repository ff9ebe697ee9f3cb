#include <algorithm>
#include <cmath>

#include <barchan/core/lane.hpp>

// Particles that left the domain, and the links that go with them; what a run that goes wrong says.

namespace barchan {
namespace {

template <int Dim>
void take_worst_pair(const ParticleStore<Dim>& store, const PeriodicBox& box, const PairList& list,
                     WorstOverlap& worst) {
  for (std::int64_t k = 0; k < list.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const std::int32_t i = list.i[at], j = list.j[at];
    if (list.code[at] == LawTable::kBonded || i == store.waste()) continue;
    const double reach = store.radius(i) + store.radius(j),
                 least = std::min(store.radius(i), store.radius(j));
    const double known = reach - worst.share * least;  // no root for those that overlap less
    const double d2 = distance2<Dim>(box, store.x(i), store.x(j));
    if (d2 >= known * known && known > 0.0) continue;
    const double overlap = reach - std::sqrt(d2);
    if (!(overlap > worst.share * least)) continue;
    worst.share = overlap / least;
    worst.overlap = overlap;
    worst.id = store.id[static_cast<std::size_t>(i)];
    worst.with = store.id[static_cast<std::size_t>(j)];
    worst.wall = -1;
    std::copy_n(store.x(i), Dim, worst.position);
  }
}

}  // namespace

template <int Dim>
std::vector<Departure> Lane<Dim>::outside(std::int64_t step) const {
  std::vector<Departure> found;
  for (std::int32_t i = 0; i < store_.num_owned; ++i) {
    if (world_->grid.contains(store_.x(i))) continue;
    Departure& d = found.emplace_back();
    d.step = step;
    d.id = store_.id[static_cast<std::size_t>(i)];
    std::copy_n(store_.x(i), Dim, d.position);
    std::copy_n(store_.v(i), Dim, d.velocity);
  }
  return found;
}

/// A bond across a cut counts on its right.
template <int Dim>
bool Lane<Dim>::counts_bond(std::int32_t bond) const {
  return !bonds_.is_broken(bond) &&
         std::max(bonds_.end_a(bond), bonds_.end_b(bond)) < store_.ghost_begin(Right);
}

template <int Dim>
LinkCounts Lane<Dim>::remove(std::span<const std::int64_t> ids) {
  removed_.assign(ids.begin(), ids.end());
  LinkCounts gone;
  unpack_history();
  const auto count = [&](const PairList& list) {
    for (std::int64_t k = 0; k < list.size(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      const bool goes =
          list.template has_spring<Dim>(k) && (is_removed(list.i[at]) || is_removed(list.j[at]));
      gone.contacts += goes ? 1 : 0;
    }
  };
  for (const PairList& list : lists_) count(list);
  if (bands_[Left].exists) count(bands_[Left].across);
  for (const WallContact<Dim>& c : walls_.list())
    gone.wall_contacts += has_spring(c) && is_removed(c.row) ? 1 : 0;
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(bonds_.bonds().size()); ++b) {
    if (!is_removed(bonds_.end_a(b)) && !is_removed(bonds_.end_b(b))) continue;
    gone.bonds += counts_bond(b) ? 1 : 0;
    bonds_.cancel(b);
  }
  return gone;
}

template <int Dim>
std::int32_t Lane<Dim>::fastest_row() const {
  std::int32_t fastest = -1;
  double most = -1.0;
  for (std::int32_t i = 0; i < store_.num_owned; ++i) {
    double v2 = 0.0;
    for (int c = 0; c < Dim; ++c) v2 += store_.v(i)[c] * store_.v(i)[c] + 0.0 * store_.x(i)[c];
    if (!std::isfinite(v2)) return i;
    if (v2 > most) fastest = i, most = v2;
  }
  return fastest;
}

template <int Dim>
typename Lane<Dim>::Partners Lane<Dim>::partners(std::int32_t row) {
  Partners found;
  const PeriodicBox& box = world_->grid.box();
  const auto look = [&](const PairList& list) {
    for (std::size_t k = 0; k < list.i.size(); ++k) {
      if (list.i[k] != row && list.j[k] != row) continue;
      const double reach = store_.radius(list.i[k]) + store_.radius(list.j[k]);
      if (distance2<Dim>(box, store_.x(list.i[k]), store_.x(list.j[k])) >= reach * reach) continue;
      const std::int32_t other = list.i[k] == row ? list.j[k] : list.i[k];
      found.ids.push_back(store_.id[static_cast<std::size_t>(other)]);
    }
  };
  for (const PairList& list : lists_) look(list);
  for (const Band& band : bands_) {
    if (band.exists) look(band.across);
  }
  double to_wall[3] = {};
  for (const WallContact<Dim>& c : walls_.list()) {
    const auto w = static_cast<std::size_t>(c.wall);
    if (c.row != row) continue;
    if (WallContacts<Dim>::nearest(world_->wall_specs[w], world_->walls[w], store_.x(row),
                                   to_wall) < store_.radius(row))
      found.walls.push_back(c.wall);
  }
  return found;
}

template <int Dim>
WorstOverlap Lane<Dim>::worst_overlap() const {
  WorstOverlap worst;
  const PeriodicBox& box = world_->grid.box();
  for (const PairList& list : lists_) take_worst_pair(store_, box, list, worst);
  if (bands_[Left].exists) take_worst_pair(store_, box, bands_[Left].across, worst);
  double to_wall[3] = {};
  for (const WallContact<Dim>& c : walls_.list()) {
    const auto w = static_cast<std::size_t>(c.wall);
    const double radius = store_.radius(c.row);
    const double overlap =
        radius - WallContacts<Dim>::nearest(world_->wall_specs[w], world_->walls[w],
                                            store_.x(c.row), to_wall);
    if (!(overlap > worst.share * radius)) continue;
    worst = {overlap / radius, overlap, store_.id[static_cast<std::size_t>(c.row)], 0, c.wall, {}};
    std::copy_n(store_.x(c.row), Dim, worst.position);
  }
  return worst;
}

template std::vector<Departure> Lane<2>::outside(std::int64_t) const;
template std::vector<Departure> Lane<3>::outside(std::int64_t) const;
template bool Lane<2>::counts_bond(std::int32_t) const;
template bool Lane<3>::counts_bond(std::int32_t) const;
template std::int32_t Lane<2>::fastest_row() const;
template std::int32_t Lane<3>::fastest_row() const;
template Lane<2>::Partners Lane<2>::partners(std::int32_t);
template Lane<3>::Partners Lane<3>::partners(std::int32_t);
template WorstOverlap Lane<2>::worst_overlap() const;
template WorstOverlap Lane<3>::worst_overlap() const;
template LinkCounts Lane<2>::remove(std::span<const std::int64_t>);
template LinkCounts Lane<3>::remove(std::span<const std::int64_t>);

}  // namespace barchan
