#include <algorithm>
#include <cmath>
#include <limits>

#include <barchan/core/brick/lane.hpp>

// Particles that left the domain, and the links that go with them; what a run that goes wrong says.

namespace barchan {
namespace {

/// Squared distance of what touches, of what would be if it just did: where a particle was follows
/// from where it is but for rounding.
constexpr double kTouching = 1.0 - 1e-9;

template <int Dim>
void take_worst_pair(const ParticleStore<Dim>& store, const PeriodicBox& box, const PairList& list,
                     WorstOverlap& worst) {
  for (std::int64_t k = 0; k < list.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const std::int32_t i = list.i[at], j = list.j[at];
    if (list.code[at] == LawTable::kBonded || i == store.waste()) continue;
    const double reach = store.radius(i) + store.radius(j),
                 least = std::min(store.radius(i), store.radius(j));
    // No root for those that overlap less.
    const double known = reach - kTouching * worst.share * least;
    const double d2 = distance2<Dim>(box, store.x(i), store.x(j));
    if (d2 >= known * known && known > 0.0) continue;
    const double overlap = reach - std::sqrt(d2);
    // The lower id first: which row is i depends on cells and cuts.
    const auto id_of = [&store](std::int32_t row) {
      return store.id[static_cast<std::size_t>(row)];
    };
    const auto [first, second] = id_of(i) < id_of(j) ? std::pair(i, j) : std::pair(j, i);
    WorstOverlap here{overlap / least, overlap, id_of(first), id_of(second), -1, {}};
    std::copy_n(store.x(first), Dim, here.position);
    if (overlap > 0.0 && here.is_worse_than(worst)) worst = here;
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
         std::max(bonds_.end_a(bond), bonds_.end_b(bond)) < store_.ghost_begin(Side::Right);
}

template <int Dim>
LinkCounts Lane<Dim>::remove(std::span<const std::int64_t> ids) {
  removed_.assign(ids.begin(), ids.end());
  LinkCounts gone;
  unpack_history();
  const auto count = [&](const PairList& list) {
    for (std::int64_t k = 0; k < list.size(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      const bool goes = list.has_history(k) && (is_removed(list.i[at]) || is_removed(list.j[at]));
      gone.contacts += goes ? 1 : 0;
    }
  };
  count(pairs_);
  if (band(Side::Left).exists) count(band(Side::Left).across);
  for (const WallContact<Dim>& c : walls_.list())
    gone.wall_contacts += has_history(c) && is_removed(c.row) ? 1 : 0;
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(bonds_.bonds().size()); ++b) {
    if (!is_removed(bonds_.end_a(b)) && !is_removed(bonds_.end_b(b))) continue;
    gone.bonds += counts_bond(b) ? 1 : 0;
    bonds_.cancel(b);
  }
  return gone;
}

template <int Dim>
std::int32_t Lane<Dim>::first_fast_row() const {
  std::int32_t first = -1;
  const auto id = [this](std::int32_t row) { return store_.id[static_cast<std::size_t>(row)]; };
  for (std::int32_t i = 0; i < store_.num_owned; ++i) {
    if (is_beyond(step_travel(store_, world_->dt, i)) && (first < 0 || id(i) < id(first)))
      first = i;
  }
  return first >= 0 ? first : fastest_row();
}

template <int Dim>
std::int32_t Lane<Dim>::fastest_row() const {
  std::int32_t fastest = -1;
  double most = -1.0;
  for (std::int32_t i = 0; i < store_.num_owned; ++i) {
    const double v2 = suspect_of(store_, i).speed2;
    const bool is_first = v2 == most && store_.id[static_cast<std::size_t>(i)] <
                                            store_.id[static_cast<std::size_t>(fastest)];
    if (v2 > most || is_first) fastest = i, most = v2;
  }
  return fastest;
}

template <int Dim>
Suspect Lane<Dim>::suspect(std::int32_t row) const {
  return suspect_of(store_, row);
}

template <int Dim>
void Lane<Dim>::find_touching(const Suspect& other, std::vector<std::int64_t>& ids) const {
  for (std::int32_t i = 0; i < store_.num_owned; ++i) {
    const double reach = store_.radius(i) + other.radius;
    const std::int64_t id = store_.id[static_cast<std::size_t>(i)];
    if (id != other.id &&
        distance2<Dim>(world_->grid.box(), store_.x(i), other.position) < reach * reach)
      ids.push_back(id);
  }
}

template <int Dim>
typename Lane<Dim>::Partners Lane<Dim>::partners_before_step(std::int32_t row) const {
  Partners found;
  const auto before = [&](std::int32_t i) {
    std::array<double, Dim> x;
    const double drift = store_.is_owned(i) ? world_->dt : 0.0;  // ghosts have not moved yet
    for (int c = 0; c < Dim; ++c)
      x[static_cast<std::size_t>(c)] =
          store_.x(i)[c] - (drift == 0.0 ? 0.0 : drift * store_.v(i)[c]);
    return x;
  };
  const auto at = before(row);
  const bool is_finite = suspect_of(store_, row).speed2 < std::numeric_limits<double>::max();
  const auto look = [&](const PairList& list) {
    for (std::size_t k = 0; k < list.i.size(); ++k) {
      if ((list.i[k] != row && list.j[k] != row) || list.i[k] == store_.waste()) continue;
      const std::int32_t other = list.i[k] == row ? list.j[k] : list.i[k];
      const double reach = store_.radius(row) + store_.radius(other);
      if (is_finite && !(distance2<Dim>(world_->grid.box(), at.data(), before(other).data()) <
                         kTouching * reach * reach))
        continue;
      found.ids.push_back(store_.id[static_cast<std::size_t>(other)]);
    }
  };
  look(pairs_);
  for (const Band& band : bands_) {
    if (band.exists) look(band.across);
  }
  std::sort(found.ids.begin(), found.ids.end());
  for (const WallContact<Dim>& c : walls_.list()) {
    const auto w = static_cast<std::size_t>(c.wall);
    if (c.row != row || (!found.walls.empty() && found.walls.back() == c.wall)) continue;
    const Vec3& point = world_->walls[w].point;
    if (!is_finite ||
        world_->wall_shapes[w].foot(point, c.image, at.data()).distance < store_.radius(row))
      found.walls.push_back(c.wall);
  }
  return found;
}

template <int Dim>
WorstOverlap Lane<Dim>::worst_overlap() const {
  WorstOverlap worst;
  const PeriodicBox& box = world_->grid.box();
  take_worst_pair(store_, box, pairs_, worst);
  if (band(Side::Left).exists) take_worst_pair(store_, box, band(Side::Left).across, worst);
  for (const WallContact<Dim>& c : walls_.list()) {
    const auto w = static_cast<std::size_t>(c.wall);
    const double radius = store_.radius(c.row);
    const double overlap =
        radius -
        world_->wall_shapes[w].foot(world_->walls[w].point, c.image, store_.x(c.row)).distance;
    WorstOverlap here{overlap / radius, overlap, store_.id[static_cast<std::size_t>(c.row)], 0,
                      c.wall,           {}};
    std::copy_n(store_.x(c.row), Dim, here.position);
    if (overlap > 0.0 && here.is_worse_than(worst)) worst = here;
  }
  return worst;
}

template std::vector<Departure> Lane<2>::outside(std::int64_t) const;
template std::vector<Departure> Lane<3>::outside(std::int64_t) const;
template bool Lane<2>::counts_bond(std::int32_t) const;
template bool Lane<3>::counts_bond(std::int32_t) const;
template std::int32_t Lane<2>::first_fast_row() const;
template std::int32_t Lane<2>::fastest_row() const;
template Suspect Lane<2>::suspect(std::int32_t) const;
template void Lane<2>::find_touching(const Suspect&, std::vector<std::int64_t>&) const;
template std::int32_t Lane<3>::first_fast_row() const;
template std::int32_t Lane<3>::fastest_row() const;
template Suspect Lane<3>::suspect(std::int32_t) const;
template void Lane<3>::find_touching(const Suspect&, std::vector<std::int64_t>&) const;
template Lane<2>::Partners Lane<2>::partners_before_step(std::int32_t) const;
template Lane<3>::Partners Lane<3>::partners_before_step(std::int32_t) const;
template WorstOverlap Lane<2>::worst_overlap() const;
template WorstOverlap Lane<3>::worst_overlap() const;
template LinkCounts Lane<2>::remove(std::span<const std::int64_t>);
template LinkCounts Lane<3>::remove(std::span<const std::int64_t>);

}  // namespace barchan
