#include <algorithm>
#include <cmath>

#include <barchan/core/brick/lane.hpp>
#include <barchan/core/model/digest.hpp>

namespace barchan {

void Measures::add(const Measures& other) {
  kinetic.add(other.kinetic);
  elastic.add(other.elastic);
  gravitational.add(other.gravitational);
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
    double v2 = 0.0, u2 = 0.0, height = 0.0;
    for (int c = 0; c < Dim; ++c) {
      v2 += store.v(i)[c] * store.v(i)[c];
      height -= gravity[c] * store.x(i)[c];
      m.momentum[c].add(mass * store.v(i)[c]);
    }
    for (int c = 0; c < kSpins<Dim>; ++c) u2 += store.u(i)[c] * store.u(i)[c];
    m.kinetic.add(0.5 * mass * (v2 + u2 / Layout<Dim>::kSpinGain));
    m.gravitational.add(mass * height);
    m.max_speed = std::max(m.max_speed, std::sqrt(v2));
    m.max_inverse_mass = std::max(m.max_inverse_mass, im);
  }
}

template <int Dim>
void measure_pairs(const Lane<Dim>& lane, const PairList& list, Measures& m) {
  const auto& store = lane.store();
  const PeriodicBox& box = lane.world().grid.box();
  const LawTable& laws = lane.world().laws;
  const ContactLawIn<Dim>& law = laws.law().template in<Dim>();
  for (std::int64_t k = 0; k < list.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (list.code[at] == LawTable::kBonded) continue;
    const std::int32_t i = list.i[at], j = list.j[at];
    const double d2 = distance2<Dim>(box, store.x(i), store.x(j));
    const double reach = store.radius(i) + store.radius(j);
    if (d2 >= reach * reach) continue;
    const double overlap = reach - std::sqrt(d2);
    const double* numbers = list.history_of(k);
    double history[kMostHistory];
    for (int c = 0; c < law.history.length; ++c) history[c] = numbers[c * kBatch];
    m.elastic.add(law.energy(laws.row(list.code[at]), overlap, history));
    m.max_overlap = std::max(m.max_overlap, overlap);
    m.max_overlap_share =
        std::max(m.max_overlap_share, overlap / std::min(store.radius(i), store.radius(j)));
    ++m.contacts;
  }
}

template <int Dim>
void measure_wall_contacts(const Lane<Dim>& lane, Measures& m) {
  const auto& store = lane.store();
  const auto& world = lane.world();
  const auto walls = lane.wall_contacts().list();
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const WallContact<Dim>& c = walls[k];
    const auto w = static_cast<std::size_t>(c.wall);
    const double overlap =
        store.radius(c.row) -
        world.wall_shapes[w].foot(world.walls[w].point, c.image, store.x(c.row)).distance;
    if (overlap <= 0.0 || !lane.wall_contacts().is_felt(store, world.wall_view(), k)) continue;
    const double* row = world.laws.row(
        world.laws.code(world.wall_specs[w].material, store.type[static_cast<std::size_t>(c.row)]));
    m.elastic.add(world.laws.law().template in<Dim>().energy(row, overlap, c.history));
    m.max_overlap = std::max(m.max_overlap, overlap);
    m.max_overlap_share = std::max(m.max_overlap_share, overlap / store.radius(c.row));
  }
}

}  // namespace

template <int Dim>
Measures Lane<Dim>::measure(const Vec3& gravity) {
  unpack_history();
  Measures m;
  measure_motion(store_, gravity, m);
  measure_pairs(*this, pairs_, m);
  if (band(Side::Left).exists)
    measure_pairs(*this, band(Side::Left).across, m);  // a pair across a cut counts on its right
  measure_wall_contacts(*this, m);
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(bonds_.bonds().size()); ++b) {
    // A bond across a cut counts on its right, too.
    const std::int32_t last = std::max(bonds_.end_a(b), bonds_.end_b(b));
    if (bonds_.is_broken(b) || last >= store_.ghost_begin(Side::Right)) continue;
    m.elastic.add(bonds_.energy(b, store_, world_->bond_laws, world_->grid.box()));
    ++m.bonds;
  }
  m.broken_bonds = bonds_.num_broken();
  return m;
}

template <int Dim>
std::vector<WallSums> Lane<Dim>::measure_walls() const {
  std::vector<WallSums> sums(world_->walls.size());
  for (std::size_t w = 0; w < wall_sums_.size(); ++w) sums[w].work = wall_sums_[w].work;
  walls_.measure(store_, wall_frame(world_->dt), sums);
  return sums;
}

template <int Dim>
Travel Lane<Dim>::travel() const {
  Travel t;
  if (outrun_ > 1.0) t.distance2 = outrun_ * 0.25 * lists_skin_ * lists_skin_;
  const PeriodicBox& box = world_->grid.box();
  for (std::int32_t i = 0; i < store_.num_owned; ++i) {
    const double *x = store_.x(i), *v = store_.v(i);
    const double* from = store_.reference.data() + std::size_t{Dim} * static_cast<std::size_t>(i);
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
std::int64_t Lane<Dim>::last_outside() const {
  std::int64_t last = 0;
  for (std::int32_t i = 0; i < store_.num_owned; ++i) {
    if (!world_->grid.contains(store_.x(i)))
      last = std::max(last, store_.id[static_cast<std::size_t>(i)]);
  }
  return last;
}

template <int Dim>
double Lane<Dim>::distance2_of_last_step() const {
  const PeriodicBox& box = world_->grid.box();
  double most = 0.0;
  for (std::int32_t i = 0; i < store_.num_owned; ++i) {
    const double* from = store_.reference.data() + std::size_t{Dim} * static_cast<std::size_t>(i);
    double before[Dim];
    for (int c = 0; c < Dim; ++c) before[c] = store_.x(i)[c] - world_->dt * store_.v(i)[c];
    most = std::max(most, distance2<Dim>(box, from, before));
  }
  return most;
}

template <int Dim>
std::uint64_t Lane<Dim>::digest() const {
  std::uint64_t sum = 0;
  for (std::int32_t i = 0; i < store_.num_owned; ++i) {
    double omega[3];
    for (int c = 0; c < kSpins<Dim>; ++c) omega[c] = store_.u(i)[c] / store_.radius(i);
    sum += particle_digest(store_.id[static_cast<std::size_t>(i)], {store_.x(i), std::size_t{Dim}},
                           {store_.v(i), std::size_t{Dim}}, {omega, std::size_t{kSpins<Dim>}});
  }
  return sum;
}

template Measures Lane<2>::measure(const Vec3&);
template Measures Lane<3>::measure(const Vec3&);
template std::vector<WallSums> Lane<2>::measure_walls() const;
template std::vector<WallSums> Lane<3>::measure_walls() const;
template Travel Lane<2>::travel() const;
template std::int64_t Lane<2>::last_outside() const;
template std::int64_t Lane<3>::last_outside() const;
template Travel Lane<3>::travel() const;
template double Lane<2>::distance2_of_last_step() const;
template double Lane<3>::distance2_of_last_step() const;
template std::uint64_t Lane<2>::digest() const;
template std::uint64_t Lane<3>::digest() const;

}  // namespace barchan
