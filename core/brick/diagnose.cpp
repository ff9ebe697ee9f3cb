#include <barchan/core/brick/diagnose.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace barchan {
namespace {

/// Squared distance of what touches, of what would be if it just did: where a particle was follows
/// from where it is but for rounding.
constexpr double kTouching = 1.0 - 1e-9;

/// The lower id first: which row is i depends on cells and cuts.
template <int Dim>
WorstOverlap overlap_of(const ParticleStore<Dim>& store, std::int32_t i, std::int32_t j,
                        double overlap) {
  const auto id_of = [&store](std::int32_t row) { return store.id[static_cast<std::size_t>(row)]; };
  const auto [first, second] = id_of(i) < id_of(j) ? std::pair(i, j) : std::pair(j, i);
  WorstOverlap here{overlap / std::min(store.radius(i), store.radius(j)),
                    overlap,
                    id_of(first),
                    id_of(second),
                    -1,
                    {}};
  std::copy_n(store.x(first), Dim, here.position);
  return here;
}
template <int Dim>
WorstOverlap overlap_of(const ParticleStore<Dim>& store, const WallContact<Dim>& c,
                        double overlap) {
  const double radius = store.radius(c.row);
  WorstOverlap here{overlap / radius, overlap, store.id[static_cast<std::size_t>(c.row)], 0,
                    c.wall,           {}};
  std::copy_n(store.x(c.row), Dim, here.position);
  return here;
}

template <int Dim>
double wall_overlap(const Brick<Dim>& brick, const WallContact<Dim>& c) {
  const World<Dim>& world = *brick.world;
  const auto w = static_cast<std::size_t>(c.wall);
  const double* x = brick.store.x(c.row);
  return brick.store.radius(c.row) -
         world.wall_shapes[w].foot(world.walls[w].point, c.image, x).distance;
}

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
    const WorstOverlap here = overlap_of(store, i, j, overlap);
    if (overlap > 0.0 && here.is_worse_than(worst)) worst = here;
  }
}

}  // namespace

template <int Dim>
std::vector<Departure> outside(const Brick<Dim>& brick, std::int64_t step) {
  const ParticleStore<Dim>& store = brick.store;
  std::vector<Departure> found;
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    if (brick.world->grid.contains(store.x(i))) continue;
    Departure& d = found.emplace_back();
    d.step = step;
    d.id = store.id[static_cast<std::size_t>(i)];
    std::copy_n(store.x(i), Dim, d.position);
    std::copy_n(store.v(i), Dim, d.velocity);
  }
  return found;
}

template <int Dim>
std::int64_t last_outside(const Brick<Dim>& brick) {
  const ParticleStore<Dim>& store = brick.store;
  std::int64_t last = 0;
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    if (!brick.world->grid.contains(store.x(i)))
      last = std::max(last, store.id[static_cast<std::size_t>(i)]);
  }
  return last;
}

template <int Dim>
std::int32_t first_fast_row(const Brick<Dim>& brick) {
  const ParticleStore<Dim>& store = brick.store;
  const World<Dim>& world = *brick.world;
  std::int32_t first = -1;
  const auto id = [&](std::int32_t row) { return store.id[static_cast<std::size_t>(row)]; };
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    if (!(step_travel(store, world.dt, i) <= world.most_travel(brick.skin)) &&
        (first < 0 || id(i) < id(first)))
      first = i;
  }
  return first >= 0 ? first : fastest_row(brick);
}

template <int Dim>
std::int32_t fastest_row(const Brick<Dim>& brick) {
  const ParticleStore<Dim>& store = brick.store;
  std::int32_t fastest = -1;
  double most = -1.0;
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    const double v2 = suspect_of(store, i).speed2;
    const bool is_first = v2 == most && store.id[static_cast<std::size_t>(i)] <
                                            store.id[static_cast<std::size_t>(fastest)];
    if (v2 > most || is_first) fastest = i, most = v2;
  }
  return fastest;
}

template <int Dim>
void find_touching(const Brick<Dim>& brick, const Suspect& other, std::vector<std::int64_t>& ids) {
  const ParticleStore<Dim>& store = brick.store;
  const World<Dim>& world = *brick.world;
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    const double reach = store.radius(i) + other.radius;
    const std::int64_t id = store.id[static_cast<std::size_t>(i)];
    if (id != other.id &&
        distance2<Dim>(world.grid.box(), store.x(i), other.position) < reach * reach)
      ids.push_back(id);
  }
}

template <int Dim>
Partners partners_before_step(const Brick<Dim>& brick, std::int32_t row) {
  const ParticleStore<Dim>& store = brick.store;
  const World<Dim>& world = *brick.world;
  Partners found;
  const auto before = [&](std::int32_t i) {
    std::array<double, Dim> x;
    const double drift = store.is_owned(i) ? world.dt : 0.0;  // ghosts have not moved yet
    for (int c = 0; c < Dim; ++c)
      x[static_cast<std::size_t>(c)] = store.x(i)[c] - (drift == 0.0 ? 0.0 : drift * store.v(i)[c]);
    return x;
  };
  const auto at = before(row);
  const bool is_finite = suspect_of(store, row).speed2 < std::numeric_limits<double>::max();
  const auto look = [&](const PairList& list) {
    for (std::size_t k = 0; k < list.i.size(); ++k) {
      if ((list.i[k] != row && list.j[k] != row) || list.i[k] == store.waste()) continue;
      const std::int32_t other = list.i[k] == row ? list.j[k] : list.i[k];
      const double reach = store.radius(row) + store.radius(other);
      if (is_finite && !(distance2<Dim>(world.grid.box(), at.data(), before(other).data()) <
                         kTouching * reach * reach))
        continue;
      found.ids.push_back(store.id[static_cast<std::size_t>(other)]);
    }
  };
  look(brick.pairs);
  for (const Band& band : brick.bands) {
    if (band.exists) look(band.across);
  }
  std::sort(found.ids.begin(), found.ids.end());
  for (const WallContact<Dim>& c : brick.walls.list()) {
    const auto w = static_cast<std::size_t>(c.wall);
    if (c.row != row || (!found.walls.empty() && found.walls.back() == c.wall)) continue;
    const Vec3& point = world.walls[w].point;
    if (!is_finite ||
        world.wall_shapes[w].foot(point, c.image, at.data()).distance < store.radius(row))
      found.walls.push_back(c.wall);
  }
  return found;
}

template <int Dim>
WorstOverlap worst_overlap(const Brick<Dim>& brick) {
  const ParticleStore<Dim>& store = brick.store;
  WorstOverlap worst;
  const PeriodicBox& box = brick.world->grid.box();
  take_worst_pair(store, box, brick.pairs, worst);
  if (brick.band(Side::Left).exists)
    take_worst_pair(store, box, brick.band(Side::Left).across, worst);
  for (const WallContact<Dim>& c : brick.walls.list()) {
    const double overlap = wall_overlap(brick, c);
    const WorstOverlap here = overlap_of(store, c, overlap);
    if (overlap > 0.0 && here.is_worse_than(worst)) worst = here;
  }
  return worst;
}

template <int Dim>
StiffestContact stiffest_contact(const Brick<Dim>& brick) {
  const ParticleStore<Dim>& store = brick.store;
  const World<Dim>& world = *brick.world;
  const auto stable_step = world.laws.law().template in<Dim>().stable_step;
  StiffestContact worst;
  if (stable_step == nullptr) return worst;
  const auto take = [&](const double* row, const Overlap& overlap, double inverse_mass, auto what) {
    if (!(overlap.depth > 0.0) || !(inverse_mass > 0.0)) return;
    const double share = world.dt / stable_step(row, overlap, 1.0 / inverse_mass);
    if (share < worst.step_share) return;
    const StiffestContact here{share, what()};
    if (here.is_worse_than(worst)) worst = here;
  };
  brick.for_each_counted([&](const PairList& list, const PairBlock& block) {
    block.for_each_candidate(list, [&](std::size_t k, const double* /*history*/) {
      const std::int32_t i = list.i[k], j = list.j[k];
      const double reach = store.radius(i) + store.radius(j);
      const double d2 = distance2<Dim>(world.grid.box(), store.x(i), store.x(j));
      if (list.code[k] == LawTable::kBonded || d2 >= reach * reach) return;
      const double depth = reach - std::sqrt(d2);
      take(world.laws.row(list.code[k]),
           {depth, store.inverse_radius(i) + store.inverse_radius(j), reach},
           store.inverse_mass(i) + store.inverse_mass(j),
           [&] { return overlap_of(store, i, j, depth); });
    });
  });
  for (const WallContact<Dim>& c : brick.walls.list()) {
    const double depth = wall_overlap(brick, c);
    const std::int32_t material = world.wall_specs[static_cast<std::size_t>(c.wall)].material;
    take(world.laws.row(world.laws.code(material, store.type[static_cast<std::size_t>(c.row)])),
         {depth, store.inverse_radius(c.row), store.radius(c.row)}, store.inverse_mass(c.row),
         [&] { return overlap_of(store, c, depth); });
  }
  return worst;
}

template std::vector<Departure> outside(const Brick<2>&, std::int64_t);
template std::vector<Departure> outside(const Brick<3>&, std::int64_t);
template std::int64_t last_outside(const Brick<2>&);
template std::int64_t last_outside(const Brick<3>&);
template std::int32_t first_fast_row(const Brick<2>&);
template std::int32_t first_fast_row(const Brick<3>&);
template std::int32_t fastest_row(const Brick<2>&);
template std::int32_t fastest_row(const Brick<3>&);
template void find_touching(const Brick<2>&, const Suspect&, std::vector<std::int64_t>&);
template void find_touching(const Brick<3>&, const Suspect&, std::vector<std::int64_t>&);
template Partners partners_before_step(const Brick<2>&, std::int32_t);
template Partners partners_before_step(const Brick<3>&, std::int32_t);
template WorstOverlap worst_overlap(const Brick<2>&);
template WorstOverlap worst_overlap(const Brick<3>&);
template StiffestContact stiffest_contact(const Brick<2>&);
template StiffestContact stiffest_contact(const Brick<3>&);

}  // namespace barchan
