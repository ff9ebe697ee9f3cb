#include <algorithm>
#include <cmath>

#include <barchan/core/links/bonds.hpp>

// The law of a bond: relative motion of the two ends in, forces and torques out.

namespace barchan {
namespace {

struct Dashpot2 {
  double ratio, inverse_mass, inverse_inertia;
  [[nodiscard]] double linear(double k) const { return 2.0 * ratio * std::sqrt(k / inverse_mass); }
  [[nodiscard]] double angular(double k) const {
    return 2.0 * ratio * std::sqrt(k / inverse_inertia);
  }
};

/// What the two ends do to each other, seen along the bond from a to b.
template <int Dim>
struct Ends {
  double r_a, r_b, distance, arm_a, arm_b, extension;
  Vec<Dim> normal, velocity;  // velocity of b relative to a
  Spin<Dim> omega_a, omega_b;
  Dashpot2 dashpot;

  Ends(const ParticleStore<Dim>& s, std::int32_t a, std::int32_t b, double length,
       const PeriodicBox& box, double ratio) {
    for (int c = 0; c < Dim; ++c) {
      normal[c] = box.nearest(s.x(b)[c] - s.x(a)[c], c);
      velocity[c] = s.v(b)[c] - s.v(a)[c];
    }
    double d2 = 0.0;
    for (int c = 0; c < Dim; ++c) d2 += normal[c] * normal[c];
    distance = std::sqrt(d2);
    normal /= distance;
    r_a = s.radius(a), r_b = s.radius(b);
    arm_a = distance * (r_a / (r_a + r_b));
    arm_b = distance * (r_b / (r_a + r_b));
    extension = distance - length;
    for (int c = 0; c < kSpins<Dim>; ++c) {
      omega_a[c] = s.u(a)[c] / r_a;
      omega_b[c] = s.u(b)[c] / r_b;
    }
    const double gain = Layout<Dim>::kSpinGain;
    const double im_a = s.inverse_mass(a), im_b = s.inverse_mass(b);
    dashpot = {ratio, im_a + im_b, gain * (im_a / (r_a * r_a) + im_b / (r_b * r_b))};
  }
};

Vec3 cross(const Vec3& p, const Vec3& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
double dot(const Vec3& p, const Vec3& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
double length_of(const Vec3& p) {
  return std::sqrt(dot(p, p));
}

using Records2 = std::array<std::array<double, 4>, 2>;
using Records3 = std::array<std::array<double, 8>, 2>;

bool respond_2d(const Ends<2>& e, const BondLaw& law, const BondSection& s, double dt,
                std::array<double, 2>& state, Records2& out) {
  const double tx = -e.normal[1], ty = e.normal[0];
  const double vn = e.velocity[0] * e.normal[0] + e.velocity[1] * e.normal[1];
  const double vt =
      e.velocity[0] * tx + e.velocity[1] * ty - (e.omega_a[0] * e.arm_a + e.omega_b[0] * e.arm_b);
  const double spin = e.omega_b[0] - e.omega_a[0];
  double &shear = state[0], &moment = state[1];
  shear += s.ks * vt * dt;
  moment += s.bending * spin * dt;
  const double tension = s.kn * e.extension;
  if (tension / s.area + std::fabs(moment) * s.radius / s.inertia > law.tensile_strength)
    return false;
  if (std::fabs(shear) / s.area > law.shear_strength) return false;
  const double fn = tension + e.dashpot.linear(s.kn) * vn;
  const double ft = shear + e.dashpot.linear(s.ks) * vt;
  const double m = moment + e.dashpot.angular(s.bending) * spin;
  const double fx = fn * e.normal[0] + ft * tx, fy = fn * e.normal[1] + ft * ty;
  out[0] = {fx, fy, (e.arm_a * ft + m) / e.r_a, 0.0};
  out[1] = {-fx, -fy, (e.arm_b * ft - m) / e.r_b, 0.0};
  return true;
}

bool respond_3d(const Ends<3>& e, const BondLaw& law, const BondSection& s, double dt,
                std::array<double, 7>& state, Records3& out) {
  const Vec3& n = e.normal;
  const Vec3 arms = e.arm_a * e.omega_a + e.arm_b * e.omega_b;
  const double vn = dot(e.velocity, n);
  const Vec3 vt = e.velocity - vn * n - cross(arms, n);
  const Vec3 spin = e.omega_b - e.omega_a;
  const double twist_rate = dot(spin, n);
  const Vec3 bend_rate = spin - twist_rate * n;
  Vec3 shear(state[0], state[1], state[2]), bending(state[3], state[4], state[5]);
  shear -= dot(shear, n) * n;
  bending -= dot(bending, n) * n;
  shear += s.ks * dt * vt;
  bending += s.bending * dt * bend_rate;
  double& twist = state[6];
  twist += s.twisting * dt * twist_rate;
  for (int c = 0; c < 3; ++c) {
    state[static_cast<std::size_t>(c)] = shear[c];
    state[static_cast<std::size_t>(3 + c)] = bending[c];
  }
  const double tension = s.kn * e.extension;
  if (tension / s.area + length_of(bending) * s.radius / s.inertia > law.tensile_strength)
    return false;
  if (length_of(shear) / s.area + std::fabs(twist) * s.radius / s.polar > law.shear_strength)
    return false;
  const Vec3 ft = shear + e.dashpot.linear(s.ks) * vt;
  const Vec3 f = (tension + e.dashpot.linear(s.kn) * vn) * n + ft;
  const Vec3 m = bending + e.dashpot.angular(s.bending) * bend_rate +
                 (twist + e.dashpot.angular(s.twisting) * twist_rate) * n;
  const Vec3 lever = cross(n, ft);
  const Vec3 ta = (e.arm_a * lever + m) / e.r_a, tb = (e.arm_b * lever - m) / e.r_b;
  out[0] = {f[0], f[1], f[2], 0.0, ta[0], ta[1], ta[2], 0.0};
  out[1] = {-f[0], -f[1], -f[2], 0.0, tb[0], tb[1], tb[2], 0.0};
  return true;
}

}  // namespace

template <int Dim>
bool BondSet<Dim>::respond(std::int32_t index, const ParticleStore<Dim>& store, const BondLaw& law,
                           const PeriodicBox& box, double dt) {
  auto& bond = bonds_[static_cast<std::size_t>(index)];
  auto& out = force_[static_cast<std::size_t>(index)];
  const Ends<Dim> ends(store, end_a(index), end_b(index), bond.length, box, law.damping_ratio);
  if (ends.dashpot.inverse_mass == 0.0) return true;  // two fixed ends
  const BondSection section = bond_section<Dim>(law, bond.length, ends.r_a, ends.r_b);
  if constexpr (Dim == 2)
    return respond_2d(ends, law, section, dt, bond.state, out);
  else
    return respond_3d(ends, law, section, dt, bond.state, out);
}

template <int Dim>
double BondSet<Dim>::energy(std::int32_t index, const ParticleStore<Dim>& store,
                            std::span<const BondLaw> laws, const PeriodicBox& box) const {
  const auto& bond = bonds_[static_cast<std::size_t>(index)];
  const Ends<Dim> e(store, end_a(index), end_b(index), bond.length, box, 0.0);
  const BondSection s =
      bond_section<Dim>(laws[static_cast<std::size_t>(bond.law)], bond.length, e.r_a, e.r_b);
  const auto& q = bond.state;
  const double axial = 0.5 * s.kn * e.extension * e.extension;
  if constexpr (Dim == 2)
    return axial + 0.5 * q[0] * q[0] / s.ks + 0.5 * q[1] * q[1] / s.bending;
  else
    return axial + 0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]) / s.ks +
           0.5 * (q[3] * q[3] + q[4] * q[4] + q[5] * q[5]) / s.bending +
           0.5 * q[6] * q[6] / s.twisting;
}

template <int Dim>
typename BondSet<Dim>::Pull BondSet<Dim>::pull(std::int32_t index, const ParticleStore<Dim>& store,
                                               std::span<const BondLaw> laws,
                                               const PeriodicBox& box, double dt) const {
  const auto& bond = bonds_[static_cast<std::size_t>(index)];
  const BondLaw& law = laws[static_cast<std::size_t>(bond.law)];
  const Ends<Dim> ends(store, end_a(index), end_b(index), bond.length, box, law.damping_ratio);
  Pull pull;
  pull.extension = ends.extension;
  for (int c = 0; c < Dim; ++c) pull.towards[c] = ends.normal[c];
  if (ends.dashpot.inverse_mass == 0.0) return pull;
  const BondSection section = bond_section<Dim>(law, bond.length, ends.r_a, ends.r_b);
  auto state = bond.state;
  std::array<Record, 2> out{};
  bool holds = false;
  if constexpr (Dim == 2)
    holds = respond_2d(ends, law, section, dt, state, out);
  else
    holds = respond_3d(ends, law, section, dt, state, out);
  for (int c = 0; c < Dim && holds; ++c) pull.force[c] = out[0][static_cast<std::size_t>(c)];
  return pull;
}

template BondSet<2>::Pull BondSet<2>::pull(std::int32_t, const ParticleStore<2>&,
                                           std::span<const BondLaw>, const PeriodicBox&,
                                           double) const;
template BondSet<3>::Pull BondSet<3>::pull(std::int32_t, const ParticleStore<3>&,
                                           std::span<const BondLaw>, const PeriodicBox&,
                                           double) const;
template bool BondSet<2>::respond(std::int32_t, const ParticleStore<2>&, const BondLaw&,
                                  const PeriodicBox&, double);
template bool BondSet<3>::respond(std::int32_t, const ParticleStore<3>&, const BondLaw&,
                                  const PeriodicBox&, double);
template double BondSet<2>::energy(std::int32_t, const ParticleStore<2>&, std::span<const BondLaw>,
                                   const PeriodicBox&) const;
template double BondSet<3>::energy(std::int32_t, const ParticleStore<3>&, std::span<const BondLaw>,
                                   const PeriodicBox&) const;

}  // namespace barchan
