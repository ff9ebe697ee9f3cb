#include <barchan/core/links/walls.hpp>

#include <algorithm>
#include <cmath>

namespace barchan {
namespace {

using S = simd::Scalar;

/// Of the radius: walls that are as near as this meet.
constexpr double kMeets = 0x1p-20;

double distance_between(const Vec3& a, const Vec3& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z);
}

/// Of the radius: where a centre is as near as this to a wall, only the wall's normal says whereto.
constexpr double kOnWall = 0x1p-300;

/// A particle and the wall's point as a pair.
struct Approach {
  Vec3 to_wall;
  double reach = 0.0;
  double inverse_mass = 0.0;
};

/// A centre on or behind a wall is pushed out along the normal: the same overlap, of a foot that
/// lies a radius in front.
Approach approach_of(const WallFoot& foot, const Vec3& normal, double radius) {
  if (foot.distance > kOnWall * radius) return {foot.to_foot, radius};
  return {-radius * normal, radius + (radius - foot.distance)};
}

/// The wall turns nowhere, and is flat.
template <int Dim>
TurningPair<S, Dim> pair_with_wall(const ParticleStore<Dim>& s, std::int32_t row,
                                   const Approach& to, const Vec3& v) {
  const double *w = s.v(row), *u = s.u(row), ir = s.inverse_radius(row);
  const Vec3& d = to.to_wall;
  if constexpr (Dim == 2) {
    return {{d[0], d[1], to.reach, v[0] - w[0], v[1] - w[1], u[0], to.inverse_mass, ir},
            -u[0] * ir,
            ir,
            0.0};
  } else {
    return {{d[0], d[1], d[2], to.reach, v[0] - w[0], v[1] - w[1], v[2] - w[2], to.inverse_mass,
             u[0], u[1], u[2], ir},
            -u[0] * ir,
            -u[1] * ir,
            -u[2] * ir,
            ir,
            0.0};
  }
}

template <int Dim>
void add_to_row(ParticleStore<Dim>& store, std::int32_t i, const PairForce<S, Dim>& f) {
  double* row = store.e(i);
  row[0] += f.fx, row[1] += f.fy;
  if constexpr (Dim == 2) {
    row[2] += f.ft;
  } else {
    row[2] += f.fz;
    row[4] += f.tx, row[5] += f.ty, row[6] += f.tz;
  }
}

/// A fixed particle that is listed for the heat of the wall alone.
template <int Dim>
bool is_only_warmed(const ParticleStore<Dim>& store, const WallView<Dim>& walls,
                    const WallContact<Dim>& contact) {
  return store.inverse_mass(contact.row) == 0.0 &&
         !walls.specs[static_cast<std::size_t>(contact.wall)].is_loaded;
}

}  // namespace

void WallSums::add(const WallSums& other) {
  for (int c = 0; c < 3; ++c) {
    force[c].add(other.force[c]);
    torque[c].add(other.torque[c]);
  }
  work.add(other.work);
  heat_flow.add(other.heat_flow);
}

template <int Dim>
void WallContacts<Dim>::search(const ParticleStore<Dim>& store, const WallView<Dim>& walls,
                               double beyond) {
  list_.clear();
  loaded_.clear();
  for (std::int32_t row = 0; row < store.num_owned; ++row) {
    const bool is_fixed = store.inverse_mass(row) == 0.0;
    for (std::size_t w = 0; w < walls.specs.size(); ++w) {
      const bool is_loaded = walls.specs[w].is_loaded;
      if (!walls.states[w].is_active || (is_fixed && !is_loaded && !walls.specs[w].gives_heat()))
        continue;
      walls.shapes[w].for_each_near(
          walls.states[w].point, store.x(row), store.radius(row) + beyond,
          [&](const WallImage& image) {
            if (is_loaded) loaded_.push_back(list_.size());
            list_.push_back({row, static_cast<std::int32_t>(w), image, {}});
          });
    }
  }
  kept_.assign(loaded_.size(), Push{{}, Vec3::Zero()});
}

template <int Dim>
void WallContacts<Dim>::foresee_wrap(const ParticleStore<Dim>& store, const Grid<Dim>& grid,
                                     std::span<const WallShape<Dim>> shapes, Rows rows) {
  if (!grid.box().any()) return;
  const auto first =
      std::lower_bound(list_.begin(), list_.end(), rows.begin,
                       [](const WallContact<Dim>& c, std::int32_t row) { return c.row < row; });
  for (auto at = first; at != list_.end() && at->row < rows.end; ++at) {
    WallContact<Dim>& c = *at;
    double wrapped[3] = {};
    std::copy_n(store.x(c.row), Dim, wrapped);
    grid.wrap(wrapped);
    c.image = shapes[static_cast<std::size_t>(c.wall)].seen_after(c.image, store.x(c.row), wrapped);
  }
}

template <int Dim>
WallFoot WallContacts<Dim>::foot_of(const ParticleStore<Dim>& store, const WallView<Dim>& walls,
                                    const WallContact<Dim>& contact) {
  const auto w = static_cast<std::size_t>(contact.wall);
  return walls.shapes[w].foot(walls.states[w].point, contact.image, store.x(contact.row));
}

/// @param foot  of the contact at this place. @return null: the contact is felt itself
template <int Dim>
const WallContact<Dim>* WallContacts<Dim>::felt_instead(const ParticleStore<Dim>& store,
                                                        const WallView<Dim>& walls,
                                                        std::size_t place,
                                                        const WallFoot& foot) const {
  const std::int32_t row = list_[place].row;
  const double radius = store.radius(row), near = kMeets * radius;
  if (foot.inside > near || foot.distance >= radius + walls.range) return nullptr;
  double at[Dim];  // the foot
  for (int c = 0; c < Dim; ++c) at[c] = store.x(row)[c] + foot.to_foot[c];
  std::size_t k = place;
  while (k > 0 && list_[k - 1].row == row) --k;
  for (; k < list_.size() && list_[k].row == row; ++k) {
    const WallContact<Dim>& other = list_[k];
    const auto w = static_cast<std::size_t>(other.wall);
    if (k == place ||
        std::fabs(walls.shapes[w].foot(walls.states[w].point, other.image, at).distance) > near)
      continue;
    const WallFoot there = foot_of(store, walls, other);
    const bool is_same = distance_between(there.to_foot, foot.to_foot) <= near;
    if (!is_same || there.inside > near || k < place) return &other;
  }
  return nullptr;
}

template <int Dim>
typename WallContacts<Dim>::Push WallContacts<Dim>::push(const ParticleStore<Dim>& store,
                                                         const Frame& frame, std::size_t place,
                                                         WallContact<Dim>& contact) const {
  const auto w = static_cast<std::size_t>(contact.wall);
  const WallSpec& spec = frame.walls.specs[w];
  const WallState& state = frame.walls.states[w];
  const WallFoot foot = foot_of(store, frame.walls, contact);
  if (const auto* other = felt_instead(store, frame.walls, place, foot)) {
    std::copy(std::begin(other->history), std::end(other->history), contact.history);
    return {{}, Vec3::Zero()};
  }
  Approach to = approach_of(foot, spec.normal, store.radius(contact.row));
  to.inverse_mass = store.inverse_mass(contact.row) + (spec.is_loaded ? 1.0 / spec.mass : 0.0);
  const auto pair = pair_with_wall(store, contact.row, to, state.velocity);
  const auto type = store.type[static_cast<std::size_t>(contact.row)];
  const LawTable& laws = *frame.laws;
  const ContactLawIn<Dim>& law = laws.law().template in<Dim>();
  const double* row = laws.row(laws.code(spec.material, type));
  Push p{{}, Vec3::Zero()};
  if (frame.losses != nullptr && law.losses != nullptr)
    p.losses = law.losses(laws.level(), row, pair, {frame.dt, frame.kick}, contact.history);
  p.on_particle = law.respond(laws.level(), row, pair, frame.dt, contact.history);
  p.on_wall[0] = -p.on_particle.fx;
  p.on_wall[1] = -p.on_particle.fy;
  if constexpr (Dim == 3) p.on_wall[2] = -p.on_particle.fz;
  return p;
}

template <int Dim>
void WallContacts<Dim>::press(const ParticleStore<Dim>& store, const Frame& frame,
                              std::span<WallSums> sums) {
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    WallContact<Dim>& contact = list_[loaded_[k]];
    const Push p = push(store, frame, loaded_[k], contact);
    kept_[k] = p;
    if (p.on_wall.isZero(0.0)) continue;
    for (int c = 0; c < Dim; ++c)
      sums[static_cast<std::size_t>(contact.wall)].force[c].add(p.on_wall[c]);
  }
}

template <int Dim>
void WallContacts<Dim>::add_to_rows(ParticleStore<Dim>& store, const Frame& frame,
                                    std::span<WallSums> sums, std::int32_t begin,
                                    std::int32_t end) {
  auto it =
      std::lower_bound(list_.begin(), list_.end(), begin,
                       [](const WallContact<Dim>& c, std::int32_t row) { return c.row < row; });
  auto kept = std::lower_bound(loaded_.begin(), loaded_.end(),
                               static_cast<std::size_t>(it - list_.begin())) -
              loaded_.begin();
  const auto note = [&](std::int32_t row, const Losses& losses) {
    if (frame.losses != nullptr) frame.losses->push_back({row, losses});
  };
  for (; it != list_.end() && it->row < end; ++it) {
    const auto w = static_cast<std::size_t>(it->wall);
    if (frame.walls.specs[w].is_loaded) {
      const Push& p = kept_[static_cast<std::size_t>(kept++)];
      add_to_row(store, it->row, p.on_particle);
      note(it->row, p.losses);
      continue;
    }
    if (is_only_warmed(store, frame.walls, *it)) continue;
    const Push p = push(store, frame, static_cast<std::size_t>(it - list_.begin()), *it);
    add_to_row(store, it->row, p.on_particle);
    note(it->row, p.losses);
    const Vec3& v = frame.walls.states[w].velocity;
    const bool moves = v[0] != 0.0 || v[1] != 0.0 || v[2] != 0.0;
    if (!moves || p.on_wall.isZero(0.0)) continue;
    for (int c = 0; c < Dim; ++c) sums[w].work.add(-p.on_wall[c] * v[c] * frame.dt);
  }
}

template <int Dim>
void WallContacts<Dim>::measure(const ParticleStore<Dim>& store, const Frame& frame,
                                std::span<WallSums> sums) const {
  for (std::size_t k = 0; k < list_.size(); ++k) {
    WallContact<Dim> contact = list_[k];
    if (is_only_warmed(store, frame.walls, contact)) continue;
    const Push p = push(store, frame, k, contact);
    if (p.on_wall.isZero(0.0)) continue;
    const auto w = static_cast<std::size_t>(contact.wall);
    WallSums& sum = sums[w];
    const Vec3 r =
        frame.walls.shapes[w].arm(frame.walls.states[w].point, contact.image, store.x(contact.row),
                                  foot_of(store, frame.walls, contact));
    const Vec3& f = p.on_wall;
    const double about[3] = {r[1] * f[2] - r[2] * f[1], r[2] * f[0] - r[0] * f[2],
                             r[0] * f[1] - r[1] * f[0]};
    for (int c = 0; c < 3; ++c) {
      sum.force[c].add(f[c]);
      sum.torque[c].add(about[c]);
    }
  }
}

template <int Dim>
std::vector<WallPush> WallContacts<Dim>::pushes(const ParticleStore<Dim>& store,
                                                const Frame& frame) const {
  std::vector<WallPush> all;
  for (std::size_t k = 0; k < list_.size(); ++k) {
    WallContact<Dim> contact = list_[k];
    if (is_only_warmed(store, frame.walls, contact)) continue;
    const Push p = push(store, frame, k, contact);
    if (p.on_wall.isZero(0.0)) continue;
    const Vec3& normal = frame.walls.specs[static_cast<std::size_t>(contact.wall)].normal;
    const WallFoot foot = foot_of(store, frame.walls, contact);
    const double radius = store.radius(contact.row);
    all.push_back({contact.row, contact.wall, approach_of(foot, normal, radius).to_wall,
                   radius - foot.distance, -1.0 * p.on_wall});
  }
  return all;
}

template class WallContacts<2>;
template class WallContacts<3>;

}  // namespace barchan
