#include <barchan/core/walls.hpp>

#include <algorithm>
#include <cmath>

namespace barchan {
namespace {

using S = simd::Scalar;

LawConstants<S> constants_of(const LawTable& laws, std::uint8_t code) {
  const double* r = laws.view().rows + LawView::kRow * code;
  return {r[LawView::Kn],     r[LawView::Kt],         r[LawView::InverseKt], r[LawView::Mu],
          r[LawView::Cap],    r[LawView::Cn],         r[LawView::Ct],        r[LawView::CnRate],
          r[LawView::CtRate], r[LawView::CnCritical], r[LawView::CtCritical]};
}

template <int Dim>
PairState<S, Dim> pair_with_wall(const ParticleStore<Dim>& s, std::int32_t row, const double* d,
                                 const Vec3& v) {
  const double *w = s.v(row), *u = s.u(row);
  if constexpr (Dim == 2) {
    return {d[0], d[1], s.radius(row), v[0] - w[0], v[1] - w[1], u[0], s.inverse_mass(row)};
  } else {
    return {d[0],        d[1],        d[2],        s.radius(row),
            v[0] - w[0], v[1] - w[1], v[2] - w[2], s.inverse_mass(row),
            u[0],        u[1],        u[2]};
  }
}

template <int Dim, Damping D>
PairForce<S, Dim> force_of(const LawConstants<S>& c, const PairState<S, Dim>& pair, double dt,
                           double (&spring)[Layout<Dim>::kSprings]) {
  PairForce<S, Dim> f{};
  if constexpr (Dim == 2)
    respond<S, D>(c, pair, dt, spring[0], f);
  else
    respond<S, D>(c, pair, dt, spring, f);
  return f;
}

template <int Dim>
PairForce<S, Dim> respond_as(Damping damping, const LawConstants<S>& c,
                             const PairState<S, Dim>& pair, double dt,
                             double (&spring)[Layout<Dim>::kSprings]) {
  if (damping == Damping::Constant) return force_of<Dim, Damping::Constant>(c, pair, dt, spring);
  if (damping == Damping::Rate) return force_of<Dim, Damping::Rate>(c, pair, dt, spring);
  return force_of<Dim, Damping::Critical>(c, pair, dt, spring);
}

/// The second in-plane axis of a plate: z in 2D never matters; in 3D the one across `normal` and
/// `along`.
void in_plane_axes(const Vec3& n, Vec3& along, Vec3& across) {
  // The width runs along the coordinate axis least aligned with the normal, turned into the plane.
  int least = 0;
  for (int c = 1; c < 3; ++c) {
    if (std::fabs(n[c]) < std::fabs(n[least])) least = c;
  }
  Vec3 axis = Vec3::Zero();
  axis[least] = 1.0;
  along = axis - n[least] * n;
  along /= std::sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
  across = Vec3(n[1] * along[2] - n[2] * along[1], n[2] * along[0] - n[0] * along[2],
                n[0] * along[1] - n[1] * along[0]);
}

}  // namespace

void WallSums::add(const WallSums& other) {
  for (int c = 0; c < 3; ++c) {
    force[c].add(other.force[c]);
    torque[c].add(other.torque[c]);
  }
  work.add(other.work);
}

void WallSums::add_force(const WallState& state, const Vec3& at, const Vec3& f) {
  const Vec3 arm = at - state.point;
  const double about[3] = {arm[1] * f[2] - arm[2] * f[1], arm[2] * f[0] - arm[0] * f[2],
                           arm[0] * f[1] - arm[1] * f[0]};
  for (int c = 0; c < 3; ++c) {
    force[c].add(f[c]);
    torque[c].add(about[c]);
  }
}

template <int Dim>
double WallContacts<Dim>::nearest(const WallSpec& spec, const WallState& state, const double* x,
                                  double* to_wall) {
  Vec3 d = state.point;
  for (int c = 0; c < Dim; ++c) d[c] -= x[c];
  const Vec3& n = spec.normal;
  double height = -(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);  // of the particle over the wall
  if (spec.kind == WallKind::Plane) {
    // Deep behind a plane the push still goes out along the normal.
    for (int c = 0; c < Dim; ++c) to_wall[c] = -std::max(height, 1e-9) * n[c];
    return height;
  }
  Vec3 along, across;
  if constexpr (Dim == 2)
    along = Vec3(-n[1], n[0], 0.0), across = Vec3::Zero();
  else
    in_plane_axes(n, along, across);
  const double a = d[0] * along[0] + d[1] * along[1] + d[2] * along[2];
  const double b = d[0] * across[0] + d[1] * across[1] + d[2] * across[2];
  const double beyond_a = a - std::clamp(a, -0.5 * spec.width, 0.5 * spec.width);
  const double beyond_b = Dim == 3 ? b - std::clamp(b, -0.5 * spec.depth, 0.5 * spec.depth) : 0.0;
  double d2 = 0.0;
  for (int c = 0; c < Dim; ++c) {
    to_wall[c] = -height * n[c] + beyond_a * along[c] + beyond_b * across[c];
    d2 += to_wall[c] * to_wall[c];
  }
  return std::sqrt(d2);
}

template <int Dim>
void WallContacts<Dim>::search(const ParticleStore<Dim>& store, std::span<const WallSpec> specs,
                               std::span<const WallState> states, double skin) {
  list_.clear();
  double to_wall[3] = {};
  for (std::int32_t row = 0; row < store.num_owned; ++row) {
    if (store.inverse_mass(row) == 0.0) continue;  // fixed
    for (std::size_t w = 0; w < specs.size(); ++w) {
      if (!states[w].is_active) continue;
      if (nearest(specs[w], states[w], store.x(row), to_wall) >= store.radius(row) + skin) continue;
      list_.push_back({row, static_cast<std::int32_t>(w), {}});
    }
  }
}

template <int Dim>
typename WallContacts<Dim>::Push WallContacts<Dim>::push(const ParticleStore<Dim>& store,
                                                         const Frame& frame,
                                                         WallContact<Dim>& contact) {
  const auto w = static_cast<std::size_t>(contact.wall);
  const WallSpec& spec = frame.specs[w];
  double d[3] = {};
  nearest(spec, frame.states[w], store.x(contact.row), d);
  const auto pair = pair_with_wall(store, contact.row, d, frame.states[w].velocity);
  const auto type = store.type[static_cast<std::size_t>(contact.row)];
  const auto law = constants_of(*frame.laws, frame.laws->code(spec.material, type));
  Push p{respond_as(frame.laws->damping(), law, pair, frame.dt, contact.spring), Vec3::Zero(),
         Vec3::Zero()};
  for (int c = 0; c < Dim; ++c) p.at[c] = store.x(contact.row)[c] + d[c];
  p.on_wall[0] = -p.on_particle.fx;
  p.on_wall[1] = -p.on_particle.fy;
  if constexpr (Dim == 3) p.on_wall[2] = -p.on_particle.fz;
  return p;
}

template <int Dim>
void WallContacts<Dim>::add_to_rows(ParticleStore<Dim>& store, const Frame& frame,
                                    std::span<WallSums> sums, std::int32_t begin,
                                    std::int32_t end) {
  auto it =
      std::lower_bound(list_.begin(), list_.end(), begin,
                       [](const WallContact<Dim>& c, std::int32_t row) { return c.row < row; });
  for (; it != list_.end() && it->row < end; ++it) {
    const Push p = push(store, frame, *it);
    double* row = store.f(it->row);
    row[0] += p.on_particle.fx, row[1] += p.on_particle.fy;
    if constexpr (Dim == 2) {
      row[2] += p.on_particle.ft;
    } else {
      row[2] += p.on_particle.fz;
      row[4] += p.on_particle.tx, row[5] += p.on_particle.ty, row[6] += p.on_particle.tz;
    }
    const auto w = static_cast<std::size_t>(it->wall);
    const Vec3& v = frame.states[w].velocity;
    const bool moves = frame.specs[w].is_loaded || v[0] != 0.0 || v[1] != 0.0 || v[2] != 0.0;
    if (!moves || p.on_wall.isZero(0.0)) continue;
    for (int c = 0; c < Dim; ++c) {
      sums[w].force[c].add(p.on_wall[c]);
      sums[w].work.add(-p.on_wall[c] * v[c] * frame.dt);
    }
  }
}

template <int Dim>
void WallContacts<Dim>::measure(const ParticleStore<Dim>& store, const Frame& frame,
                                std::span<WallSums> sums) const {
  for (WallContact<Dim> contact : list_) {
    const Push p = push(store, frame, contact);
    if (!p.on_wall.isZero(0.0))
      sums[static_cast<std::size_t>(contact.wall)].add_force(
          frame.states[static_cast<std::size_t>(contact.wall)], p.at, p.on_wall);
  }
}

template class WallContacts<2>;
template class WallContacts<3>;

}  // namespace barchan
