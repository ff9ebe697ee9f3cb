#include <barchan/core/brick/links.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace barchan {
namespace {

double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// @param towards  from the first to the second [m]. @param force  on the first [N]
LinkForce link_of(std::int64_t first, std::int64_t second, const Vec3& towards, const Vec3& force) {
  LinkForce link;
  link.first = first;
  link.second = second;
  link.normal = towards / std::sqrt(dot(towards, towards));
  link.normal_force = -dot(force, link.normal);
  link.tangential_force = force + link.normal_force * link.normal;
  return link;
}

/// As seen from the other end.
void swap_ends(LinkForce& link) {
  std::swap(link.first, link.second);
  link.normal = -1.0 * link.normal;
  link.tangential_force = -1.0 * link.tangential_force;
}

template <int Dim>
typename ContactLawIn<Dim>::State pair_of(const Brick<Dim>& brick, std::int32_t i, std::int32_t j) {
  const ParticleStore<Dim>& s = brick.store;
  const PeriodicBox& box = brick.world->grid.box();
  typename ContactLawIn<Dim>::State p{};
  const double *v = s.v(i), *w = s.v(j), *u = s.u(i), *o = s.u(j);
  const auto towards = [&](int c) { return box.nearest(s.x(j)[c] - s.x(i)[c], c); };
  p.inverse_first = s.inverse_radius(i), p.inverse_second = s.inverse_radius(j);
  p.reach = s.radius(i) + s.radius(j);
  p.inverse_mass = s.inverse_mass(i) + s.inverse_mass(j);
  p.inverse_radius = p.inverse_first + p.inverse_second;
  const auto turn = [&](int c) { return o[c] * p.inverse_second - u[c] * p.inverse_first; };
  p.dx = towards(0), p.dy = towards(1);
  p.vx = w[0] - v[0], p.vy = w[1] - v[1];
  if constexpr (Dim == 2) {
    p.surface = u[0] + o[0];
    p.turn = turn(0);
  } else {
    p.dz = towards(2), p.vz = w[2] - v[2];
    p.ux = u[0] + o[0], p.uy = u[1] + o[1], p.uz = u[2] + o[2];
    p.turn_x = turn(0), p.turn_y = turn(1), p.turn_z = turn(2);
  }
  return p;
}

template <int Dim>
void list_pairs(const Brick<Dim>& brick, double dt, std::vector<LinkForce>& out) {
  const ParticleStore<Dim>& store = brick.store;
  const LawTable& laws = brick.world->laws;
  const ContactLawIn<Dim>& law = laws.law().template in<Dim>();
  const auto id = [&](std::int32_t row) { return store.id[static_cast<std::size_t>(row)]; };
  const auto list_pair = [&](const PairList& list, std::size_t k, const double* numbers) {
    const std::int32_t i = list.i[k], j = list.j[k];
    if (list.code[k] == LawTable::kBonded || i == store.waste()) return;
    const double d2 = distance2<Dim>(brick.world->grid.box(), store.x(i), store.x(j));
    const double reach = store.radius(i) + store.radius(j);
    const bool touches = d2 < reach * reach;
    if (!touches && brick.world->range == 0.0) return;
    double history[kMostHistory];
    for (int c = 0; c < law.history.length; ++c) history[c] = numbers[c * kBatch];
    const auto pair = pair_of(brick, i, j);
    const auto f = law.respond(laws.level(), laws.row(list.code[k]), pair, dt, history);
    const bool is_held =
        std::any_of(history, history + law.history.length, [](double c) { return c != 0.0; });
    if (!touches && !is_held) return;
    Vec3 towards(pair.dx, pair.dy, 0.0), force(f.fx, f.fy, 0.0);
    if constexpr (Dim == 3) towards[2] = pair.dz, force[2] = f.fz;
    LinkForce link = link_of(id(i), id(j), towards, force);
    link.overlap = reach - std::sqrt(d2);
    if (link.second < link.first) swap_ends(link);
    out.push_back(link);
  };
  brick.for_each_counted([&](const PairList& list, const PairBlock& block) {
    block.for_each_candidate(
        list, [&](std::size_t k, const double* numbers) { list_pair(list, k, numbers); });
  });
}

template <int Dim>
void list_wall_contacts(const Brick<Dim>& brick, double dt, std::vector<LinkForce>& out) {
  const World<Dim>& world = *brick.world;
  for (const WallPush& push :
       brick.walls.pushes(brick.store, {world.wall_view(), &world.laws, dt})) {
    LinkForce link = link_of(brick.store.id[static_cast<std::size_t>(push.row)], push.wall,
                             push.to_wall, push.force);
    link.overlap = push.overlap;
    out.push_back(link);
  }
}

template <int Dim>
void list_bonds(const Brick<Dim>& brick, double dt, std::vector<LinkForce>& out) {
  const World<Dim>& world = *brick.world;
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(brick.bonds.bonds().size()); ++b) {
    if (!brick.counts_bond(b)) continue;
    const Bond<Dim>& bond = brick.bonds.bonds()[static_cast<std::size_t>(b)];
    const auto pull = brick.bonds.pull(b, brick.store, world.bond_laws, world.grid.box(), dt);
    LinkForce link = link_of(bond.id_a, bond.id_b, pull.towards, pull.force);
    link.overlap = -pull.extension;
    out.push_back(link);
  }
}

}  // namespace

template <int Dim>
void list_links(const Brick<Dim>& brick, LinkKind kind, double dt, std::vector<LinkForce>& out) {
  switch (kind) {
    case LinkKind::Contacts:
      return list_pairs(brick, dt, out);
    case LinkKind::WallContacts:
      return list_wall_contacts(brick, dt, out);
    case LinkKind::Bonds:
      return list_bonds(brick, dt, out);
  }
}

template void list_links(const Brick<2>&, LinkKind, double, std::vector<LinkForce>&);
template void list_links(const Brick<3>&, LinkKind, double, std::vector<LinkForce>&);

}  // namespace barchan
