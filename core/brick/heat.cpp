#include <barchan/core/brick/heat.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <barchan/core/model/mass.hpp>
#include <barchan/core/simd/scalar.hpp>

namespace barchan {
namespace {

/// Whether a law holds two that do not touch: then some number of their history is not zero.
bool is_held(const PairJob& pairs, std::int64_t k, int length) {
  const double* numbers = pairs.history + k / kBatch * kBatch * length + k % kBatch;
  for (int c = 0; c < length; ++c) {
    if (numbers[c * kBatch] != 0.0) return true;
  }
  return false;
}

/// Squared radius of a contact. Of a bonded pair the bond carries the force, not the law, and heat
/// flows where the two overlap.
template <int Dim>
double area_of(const World<Dim>& world, std::uint8_t code, const Overlap& overlap) {
  if (code == LawTable::kBonded) return overlap.depth / overlap.inverse_radius;
  return world.laws.law().template in<Dim>().area(world.laws.row(code), overlap);
}

template <int Dim>
double capacity_of(const Brick<Dim>& brick, std::int32_t row) {
  const ParticleStore<Dim>& store = brick.store;
  const auto at = static_cast<std::size_t>(row);
  return mass_of(store.density[at], store.radius(row), Dim) *
         brick.world->heat.heat_capacity[store.type[at]];
}

/// Into the particle [W].
template <int Dim>
double flow_from_wall(const Brick<Dim>& brick, std::size_t place) {
  const ParticleStore<Dim>& store = brick.store;
  const World<Dim>& world = *brick.world;
  const WallContact<Dim>& c = brick.walls.list()[place];
  const auto w = static_cast<std::size_t>(c.wall);
  const WallSpec& spec = world.wall_specs[w];
  if (!spec.gives_heat()) return 0.0;
  const double r = store.radius(c.row);
  const double depth =
      r - world.wall_shapes[w].foot(world.walls[w].point, c.image, store.x(c.row)).distance;
  const bool holds = depth > 0.0 || (world.range > 0.0 && has_history(c));
  if (!holds || !brick.walls.is_felt(store, world.wall_view(), place)) return 0.0;
  if (spec.heat_flux) return *spec.heat_flux * (Dim == 2 ? 2.0 * r : std::numbers::pi * r * r);
  const int type = store.type[static_cast<std::size_t>(c.row)];
  const double area =
      area_of(world, world.laws.code(spec.material, type), {depth, store.inverse_radius(c.row), r});
  if (!(area > 0.0)) return 0.0;
  return conductance<Dim>(world.heat.between(spec.material, type), std::sqrt(area), r) *
         (*spec.temperature - *store.t(c.row));
}

/// Calls f(place in the list, row) for the contacts of these rows with walls.
template <int Dim, class F>
void for_each_wall_contact(const Brick<Dim>& brick, Rows rows, F&& f) {
  const auto list = brick.walls.list();
  auto it =
      std::lower_bound(list.begin(), list.end(), rows.begin,
                       [](const WallContact<Dim>& c, std::int32_t row) { return c.row < row; });
  for (; it != list.end() && it->row < rows.end; ++it)
    f(static_cast<std::size_t>(it - list.begin()), it->row);
}

/// t[0] + t[1] grows by a change, and t[0] is that sum as a double (Knuth's two-sum).
void add_to(double* t, double change) {
  const double more = change + t[1], sum = t[0] + more, part = sum - t[0];
  t[1] = (t[0] - (sum - part)) + (more - part);
  t[0] = sum;
}

}  // namespace

template <int Dim>
void conduct(Brick<Dim>& brick, const PairJob& pairs) {
  ParticleStore<Dim>& store = brick.store;
  const World<Dim>& world = *brick.world;
  const int length = world.history_form().length;
  for (std::int64_t k = pairs.begin; k < pairs.end; ++k) {
    const std::int32_t i = pairs.i[k], j = pairs.j[k];
    const double reach = store.radius(i) + store.radius(j);
    const double d2 = distance2<Dim>(pairs.box, store.x(i), store.x(j));
    const bool touches = d2 < reach * reach;
    if (!touches && !(world.range > 0.0 && is_held(pairs, k, length))) continue;
    const double area =
        area_of(world, pairs.code[k],
                {reach - std::sqrt(d2), store.inverse_radius(i) + store.inverse_radius(j), reach});
    if (!(area > 0.0)) continue;
    const auto& type = store.type;
    const double h = conductance<Dim>(
        world.heat.between(type[static_cast<std::size_t>(i)], type[static_cast<std::size_t>(j)]),
        std::sqrt(area), reach);
    // With the last bit set no sum with a multiple of the grain is a tie.
    const double flow = simd::Scalar::odd(h * (*store.t(j) - *store.t(i)));
    store.q(i)[0] += flow, store.q(i)[1] += std::abs(flow);
    store.q(j)[0] -= flow, store.q(j)[1] += std::abs(flow);
  }
}

template <int Dim>
void warm(Brick<Dim>& brick, Rows rows) {
  ParticleStore<Dim>& store = brick.store;
  const World<Dim>& world = *brick.world;
  const double rounder = world.heat.grain.rounder();
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    brick.top_flow = std::max(brick.top_flow, store.q(i)[1]);
    store.q(i)[0] -= rounder;
  }
  for_each_wall_contact(brick, rows, [&](std::size_t place, std::int32_t row) {
    store.q(row)[0] += flow_from_wall(brick, place);
  });
  for (std::int32_t i = rows.begin; i < rows.end; ++i)
    add_to(store.t(i), world.dt * store.q(i)[0] / capacity_of(brick, i));
  store.start_flows(rounder, rows.begin, rows.end);
}

template <int Dim>
void measure_heat(const Brick<Dim>& brick, Measures& m) {
  for (std::int32_t i = 0; i < brick.store.num_owned; ++i) {
    const double* t = brick.store.t(i);
    const double capacity = capacity_of(brick, i);
    m.heat.add(capacity * t[0]);
    m.heat.add(capacity * t[1]);
    m.heat_capacity.add(capacity);
    m.max_temperature = std::max(m.max_temperature, t[0]);
    m.min_temperature = std::min(m.min_temperature, t[0]);
  }
}

template <int Dim>
void measure_wall_heat(const Brick<Dim>& brick, std::span<WallSums> sums) {
  for_each_wall_contact(
      brick, {0, brick.store.num_owned}, [&](std::size_t place, std::int32_t /*row*/) {
        sums[static_cast<std::size_t>(brick.walls.list()[place].wall)].heat_flow.add(
            flow_from_wall(brick, place));
      });
}

template void conduct(Brick<2>&, const PairJob&);
template void conduct(Brick<3>&, const PairJob&);
template void warm(Brick<2>&, Rows);
template void warm(Brick<3>&, Rows);
template void measure_heat(const Brick<2>&, Measures&);
template void measure_heat(const Brick<3>&, Measures&);
template void measure_wall_heat(const Brick<2>&, std::span<WallSums>);
template void measure_wall_heat(const Brick<3>&, std::span<WallSums>);

}  // namespace barchan
