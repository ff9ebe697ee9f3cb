#include <barchan/core/brick/measure.hpp>

#include <algorithm>
#include <cmath>

#include <barchan/core/brick/heat.hpp>
#include <barchan/core/model/digest.hpp>

namespace barchan {

void Measures::add(const Measures& other) {
  kinetic.add(other.kinetic);
  elastic.add(other.elastic);
  gravitational.add(other.gravitational);
  bonds_elastic.add(other.bonds_elastic);
  sliding_elastic.add(other.sliding_elastic);
  rolling_elastic.add(other.rolling_elastic);
  works.add(other.works);
  heat.add(other.heat);
  heat_capacity.add(other.heat_capacity);
  max_temperature = std::max(max_temperature, other.max_temperature);
  min_temperature = std::min(min_temperature, other.min_temperature);
  for (int c = 0; c < 3; ++c) momentum[c].add(other.momentum[c]);
  contacts += other.contacts;
  bonds += other.bonds;
  broken_bonds += other.broken_bonds;
  max_overlap = std::max(max_overlap, other.max_overlap);
  max_overlap_share = std::max(max_overlap_share, other.max_overlap_share);
  max_speed = std::max(max_speed, other.max_speed);
  max_inverse_mass = std::max(max_inverse_mass, other.max_inverse_mass);
}

namespace {

template <int Dim>
void measure_motion(const ParticleStore<Dim>& store, const Vec3& gravity, Measures& m) {
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    const double im = store.inverse_mass(i);
    if (im == 0.0) continue;
    const double mass = 1.0 / im;
    double v2 = 0.0, height = 0.0;
    for (int c = 0; c < Dim; ++c) {
      v2 += store.v(i)[c] * store.v(i)[c];
      height -= gravity[c] * store.x(i)[c];
      m.momentum[c].add(mass * store.v(i)[c]);
    }
    m.kinetic.add(kinetic_energy(store, i));
    m.gravitational.add(mass * height);
    m.max_speed = std::max(m.max_speed, std::sqrt(v2));
    m.max_inverse_mass = std::max(m.max_inverse_mass, im);
  }
}

/// Of two that do not touch: whether the next step would find that the law still holds them.
template <int Dim>
bool holds_from_afar(const LawTable& laws, const double* row, const Overlap& overlap,
                     const double* history) {
  const ContactLawIn<Dim>& law = laws.law().template in<Dim>();
  typename ContactLawIn<Dim>::State apart{};
  apart.dx = overlap.reach - overlap.depth;
  apart.reach = overlap.reach;
  apart.inverse_mass = 1.0;
  apart.inverse_radius = overlap.inverse_radius;
  double after[kMostHistory];
  std::copy_n(history, law.history.length, after);
  (void)law.respond(laws.level(), row, apart, 0.0, after);
  return std::any_of(after, after + law.history.length, [](double c) { return c != 0.0; });
}

template <int Dim>
void measure_springs(const World<Dim>& world, const double* row, const Overlap& overlap,
                     const double* history, Measures& m) {
  const ContactLawIn<Dim>& law = world.laws.law().template in<Dim>();
  m.elastic.add(law.energy(row, overlap, history));
  if (!world.accounts || law.stored == nullptr) return;
  const Losses stored = law.stored(row, overlap, history);
  m.sliding_elastic.add(stored.sliding);
  m.rolling_elastic.add(stored.rolling);
}

template <int Dim>
void measure_pairs(const Brick<Dim>& brick, const PairList& list, const PairBlock& block,
                   Measures& m) {
  const ParticleStore<Dim>& store = brick.store;
  const PeriodicBox& box = brick.world->grid.box();
  const LawTable& laws = brick.world->laws;
  const ContactLawIn<Dim>& law = laws.law().template in<Dim>();
  block.for_each_candidate(list, [&](std::size_t k, const double* numbers) {
    if (list.code[k] == LawTable::kBonded) return;
    const std::int32_t i = list.i[k], j = list.j[k];
    const double d2 = distance2<Dim>(box, store.x(i), store.x(j));
    const double reach = store.radius(i) + store.radius(j);
    double history[kMostHistory];
    bool is_held = false;
    for (int c = 0; c < law.history.length; ++c) {
      history[c] = numbers[c * kBatch];
      is_held = is_held || history[c] != 0.0;
    }
    const bool touches = d2 < reach * reach;
    if (!touches && !(is_held && brick.world->range > 0.0)) return;
    const double depth = reach - std::sqrt(d2);
    const Overlap overlap{depth, store.inverse_radius(i) + store.inverse_radius(j), reach};
    const double* row = laws.row(list.code[k]);
    if (!touches && !holds_from_afar<Dim>(laws, row, overlap, history)) return;
    measure_springs(*brick.world, row, overlap, history, m);
    if (!touches) return;
    m.max_overlap = std::max(m.max_overlap, depth);
    m.max_overlap_share =
        std::max(m.max_overlap_share, depth / std::min(store.radius(i), store.radius(j)));
    ++m.contacts;
  });
}

template <int Dim>
void measure_wall_contacts(const Brick<Dim>& brick, Measures& m) {
  const ParticleStore<Dim>& store = brick.store;
  const World<Dim>& world = *brick.world;
  const auto walls = brick.walls.list();
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const WallContact<Dim>& c = walls[k];
    const auto w = static_cast<std::size_t>(c.wall);
    const double overlap =
        store.radius(c.row) -
        world.wall_shapes[w].foot(world.walls[w].point, c.image, store.x(c.row)).distance;
    const bool holds = overlap > 0.0 || (world.range > 0.0 && has_history(c));
    const bool is_idle = store.inverse_mass(c.row) == 0.0 && !world.wall_specs[w].is_loaded;
    if (!holds || is_idle || !brick.walls.is_felt(store, world.wall_view(), k)) continue;
    const double* row = world.laws.row(
        world.laws.code(world.wall_specs[w].material, store.type[static_cast<std::size_t>(c.row)]));
    const Overlap at{overlap, store.inverse_radius(c.row), store.radius(c.row)};
    if (overlap <= 0.0 && !holds_from_afar<Dim>(world.laws, row, at, c.history)) continue;
    measure_springs(world, row, at, c.history, m);
    if (overlap <= 0.0) continue;
    m.max_overlap = std::max(m.max_overlap, overlap);
    m.max_overlap_share = std::max(m.max_overlap_share, overlap / store.radius(c.row));
  }
}

}  // namespace

template <int Dim>
Measures measure(const Brick<Dim>& brick, const Vec3& gravity) {
  Measures m;
  measure_motion(brick.store, gravity, m);
  brick.for_each_counted(
      [&](const PairList& list, const PairBlock& block) { measure_pairs(brick, list, block, m); });
  measure_wall_contacts(brick, m);
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(brick.bonds.bonds().size()); ++b) {
    if (!brick.counts_bond(b)) continue;
    const double energy =
        brick.bonds.energy(b, brick.store, brick.world->bond_laws, brick.world->grid.box());
    m.elastic.add(energy);
    m.bonds_elastic.add(energy);
    ++m.bonds;
  }
  m.broken_bonds = brick.bonds.num_broken();
  m.works = brick.works;
  if (brick.store.has_heat) measure_heat(brick, m);
  return m;
}

EnergyBudget budget_of(const Measures& m, double wall_work) {
  using E = EnergyWorks;
  const auto of = [&](E::Part part) { return m.works[part].value(); };
  const double bonds = m.bonds_elastic.value(), contacts = m.elastic.value() - bonds;
  EnergyBudget b;
  b.wall_work = wall_work - of(E::StartWalls);
  b.gravity_work = of(E::Gravity);
  b.caller_work = of(E::Callers);
  b.contact_loss = b.wall_work - of(E::Contacts) - (contacts - of(E::StartContacts));
  b.dashpot_loss = of(E::Dashpots);
  b.sliding_loss = of(E::Sliding) - (m.sliding_elastic.value() - of(E::StartSliding));
  b.rolling_loss = of(E::Rolling) - (m.rolling_elastic.value() - of(E::StartRolling));
  b.bond_loss = -of(E::Bonds) - (bonds - of(E::StartBonds));
  b.damping_loss = -of(E::LocalDamping);
  b.departed = of(E::Departed);
  const double there = m.kinetic.value() + m.elastic.value() -
                       (of(E::StartKinetic) + of(E::StartContacts) + of(E::StartBonds));
  const double given = b.wall_work + b.gravity_work + b.caller_work;
  const double taken = b.contact_loss + b.bond_loss + b.damping_loss + b.departed;
  b.error = there - (given - taken);
  return b;
}

template <int Dim>
std::vector<WallSums> measure_walls(const Brick<Dim>& brick) {
  const World<Dim>& world = *brick.world;
  std::vector<WallSums> sums(world.walls.size());
  for (std::size_t w = 0; w < brick.wall_sums.size(); ++w) sums[w].work = brick.wall_sums[w].work;
  brick.walls.measure(brick.store, {world.wall_view(), &world.laws, world.last_dt}, sums);
  if (brick.store.has_heat) measure_wall_heat(brick, sums);
  return sums;
}

template <int Dim>
Travel travel(const Brick<Dim>& brick) {
  const ParticleStore<Dim>& store = brick.store;
  const PeriodicBox& box = brick.world->grid.box();
  Travel t;
  if (brick.outrun > 1.0) t.distance2 = brick.outrun * 0.25 * brick.skin * brick.skin;
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    const double *x = store.x(i), *v = store.v(i);
    const double* from = store.reference.data() + std::size_t{Dim} * static_cast<std::size_t>(i);
    const double d2 = distance2<Dim>(box, from, x);
    double v2 = 0.0;
    for (int c = 0; c < Dim; ++c) v2 += v[c] * v[c];
    // Written so that NaN wins.
    if (!(d2 <= t.distance2)) t.distance2 = d2;
    if (!(v2 <= t.speed2)) t.speed2 = v2;
  }
  return t;
}

template <int Dim>
double distance2_of_last_step(const Brick<Dim>& brick) {
  const ParticleStore<Dim>& store = brick.store;
  double most = 0.0;
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    const double* from = store.reference.data() + std::size_t{Dim} * static_cast<std::size_t>(i);
    double before[Dim];
    for (int c = 0; c < Dim; ++c) before[c] = store.x(i)[c] - brick.world->last_dt * store.v(i)[c];
    most = std::max(most, distance2<Dim>(brick.world->grid.box(), from, before));
  }
  return most;
}

template <int Dim>
std::uint64_t digest(const Brick<Dim>& brick, Rows rows) {
  const ParticleStore<Dim>& store = brick.store;
  std::uint64_t sum = 0;
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    double omega[3];
    for (int c = 0; c < kSpins<Dim>; ++c) omega[c] = store.u(i)[c] / store.radius(i);
    sum += particle_digest(store.id[static_cast<std::size_t>(i)], {store.x(i), std::size_t{Dim}},
                           {store.v(i), std::size_t{Dim}}, {omega, std::size_t{kSpins<Dim>}},
                           store.has_heat ? std::span(store.t(i), 2) : std::span<const double>());
  }
  return sum;
}

template Measures measure(const Brick<2>&, const Vec3&);
template Measures measure(const Brick<3>&, const Vec3&);
template std::vector<WallSums> measure_walls(const Brick<2>&);
template std::vector<WallSums> measure_walls(const Brick<3>&);
template Travel travel(const Brick<2>&);
template Travel travel(const Brick<3>&);
template double distance2_of_last_step(const Brick<2>&);
template double distance2_of_last_step(const Brick<3>&);
template std::uint64_t digest(const Brick<2>&, Rows);
template std::uint64_t digest(const Brick<3>&, Rows);

}  // namespace barchan
