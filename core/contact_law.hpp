#pragma once

#include <type_traits>

namespace barchan {

// Linear spring–dashpot with Coulomb friction, written once for one, four or eight pairs
// (S: simd/*.hpp).
//
//   fn = min(cap, cn·vn − kn·overlap)         cap = 0: the contact never pulls; +inf: it may
//   s' = s + vt·dt                            tangential spring, zero at first touch
//   ft = kt·s' + ct·vt,  |ft| <= mu·|fn|      where friction slides, s' is cut back to the limit
//
// Lengths [m], velocities [m/s], forces [N]. The response is the force on the first particle of the
// pair; the second one gets its negative, and both get the same torque / radius. All differences
// are second minus first, so swapping the two negates the force exactly: both sides of a cut agree
// to the bit. Sources: Cundall & Strack 1979, doi:10.1680/geot.1979.29.1.47; the clamp is ours.

/// Constants of one law, one per pair. A dashpot is constant + rate·m_eff + critical·sqrt(m_eff).
template <class S>
struct LawConstants {
  using Real = typename S::Real;
  Real kn, kt, inverse_kt, mu, cap;
  Real cn, ct;                                      ///< constant parts [N·s/m]
  Real cn_rate, ct_rate, cn_critical, ct_critical;  ///< read only where damping depends on mass
};

/// What a look-up of constants gives. By reference if it is the same for all pairs: compilers copy
/// hundreds of bytes for every batch otherwise.
template <class S, bool OneLaw>
using Looked = std::conditional_t<OneLaw, const LawConstants<S>&, LawConstants<S>>;

template <class S, int Dim>
struct PairState;

/// Differences (second − first) and sums over a pair of disks.
template <class S>
struct PairState<S, 2> {
  using Real = typename S::Real;
  Real dx, dy, reach;    ///< reach = r_i + r_j
  Real vx, vy, surface;  ///< surface = u_i + u_j
  Real inverse_mass;     ///< 1/m_i + 1/m_j
};

template <class S>
struct PairState<S, 3> {
  using Real = typename S::Real;
  Real dx, dy, dz, reach;
  Real vx, vy, vz, inverse_mass;
  Real ux, uy, uz;
};

/// Force on the first particle [N], and torque / radius on both. `size` is at least the largest
/// component of either.
template <class S, int Dim>
struct PairForce;

template <class S>
struct PairForce<S, 2> {
  typename S::Real fx, fy, ft, size;
};

template <class S>
struct PairForce<S, 3> {
  typename S::Real fx, fy, fz, tx, ty, tz, size;
};

template <class S>
struct Dashpots {
  typename S::Real cn, ct;
};

/// What the dashpots of a run depend on; the cheapest that serves all its laws. A law gives the
/// same bits at any level.
enum class Damping { Constant, Rate, Critical };

/// The two dashpots at a given reduced mass.
template <class S, Damping D>
[[gnu::always_inline]] inline Dashpots<S> dashpots(const LawConstants<S>& c,
                                                   typename S::Real reduced_mass) {
  if constexpr (D == Damping::Constant) {
    return {c.cn, c.ct};
  } else {
    Dashpots<S> d{c.cn + c.cn_rate * reduced_mass, c.ct + c.ct_rate * reduced_mass};
    if constexpr (D == Damping::Critical) {
      const auto root = S::sqrt(reduced_mass);
      d.cn += c.cn_critical * root;
      d.ct += c.ct_critical * root;
    }
    return d;
  }
}

/// 1/d and the reduced mass, by one division where both are wanted.
template <class S, Damping D>
[[gnu::always_inline]] inline typename S::Real inverse_of(typename S::Real d,
                                                          typename S::Real inverse_mass,
                                                          typename S::Real& reduced_mass) {
  if constexpr (D == Damping::Constant) {
    return S::set(1.0) / d;
  } else {
    const auto q = S::set(1.0) / (d * inverse_mass);
    reduced_mass = q * d;
    return q * inverse_mass;
  }
}

/// @param spring  tangential spring [m], replaced by its value after the step; zero where the pair
/// does not touch
/// @param out  of lanes that touch; of others any number
/// @return which lanes touch
template <class S, Damping D>
[[gnu::always_inline]] inline typename S::Mask respond(const LawConstants<S>& c,
                                                       const PairState<S, 2>& p,
                                                       typename S::Real dt,
                                                       typename S::Real& spring,
                                                       PairForce<S, 2>& out) {
  using Real = typename S::Real;
  const Real zero = S::set(0.0);
  const Real d2 = p.dx * p.dx + p.dy * p.dy;
  const auto touching = S::less(d2, p.reach * p.reach);
  if (!S::any(touching)) {
    spring = zero;
    return touching;
  }
  const Real d = S::sqrt(d2);
  Real reduced_mass = zero;
  const Real inverse = inverse_of<S, D>(d, p.inverse_mass, reduced_mass);
  const Real nx = p.dx * inverse, ny = p.dy * inverse;
  const Real vn = p.vx * nx + p.vy * ny;
  const Real vt = (p.vy * nx - p.vx * ny) - p.surface;
  const auto damp = dashpots<S, D>(c, reduced_mass);

  const Real normal = damp.cn * vn - c.kn * (p.reach - d);
  const Real fn = S::select(S::less(c.cap, normal), c.cap, normal);
  const Real stretched = spring + vt * dt;
  const Real viscous = damp.ct * vt;
  const Real sticking = c.kt * stretched + viscous;
  const Real limit = c.mu * S::abs(fn);
  const auto sliding = S::less(limit, S::abs(sticking));
  const Real ft = S::select(sliding, S::copysign(limit, sticking), sticking);
  const Real kept = S::select(sliding, (ft - viscous) * c.inverse_kt, stretched);

  spring = S::where(touching, kept);
  out.fx = fn * nx - ft * ny;
  out.fy = fn * ny + ft * nx;
  out.ft = ft;
  out.size = S::abs(fn) + limit;
  return touching;
}

/// @param s  tangential spring, three components [m], kept in the tangent plane
template <class S, Damping D>
[[gnu::always_inline]] inline typename S::Mask respond(const LawConstants<S>& c,
                                                       const PairState<S, 3>& p,
                                                       typename S::Real dt,
                                                       typename S::Real (&s)[3],
                                                       PairForce<S, 3>& out) {
  using Real = typename S::Real;
  const Real zero = S::set(0.0);
  const Real d2 = p.dx * p.dx + p.dy * p.dy + p.dz * p.dz;
  const auto touching = S::less(d2, p.reach * p.reach);
  if (!S::any(touching)) {
    s[0] = s[1] = s[2] = zero;
    return touching;
  }
  const Real d = S::sqrt(d2);
  Real reduced_mass = zero;
  const Real inverse = inverse_of<S, D>(d, p.inverse_mass, reduced_mass);
  const Real nx = p.dx * inverse, ny = p.dy * inverse, nz = p.dz * inverse;
  const Real vn = p.vx * nx + p.vy * ny + p.vz * nz;
  const auto damp = dashpots<S, D>(c, reduced_mass);
  const Real normal = damp.cn * vn - c.kn * (p.reach - d);
  const Real fn = S::select(S::less(c.cap, normal), c.cap, normal);

  const Real tx = p.vx - vn * nx - (p.uy * nz - p.uz * ny);
  const Real ty = p.vy - vn * ny - (p.uz * nx - p.ux * nz);
  const Real tz = p.vz - vn * nz - (p.ux * ny - p.uy * nx);
  Real a = s[0] + tx * dt, b = s[1] + ty * dt, e = s[2] + tz * dt;
  const Real along = a * nx + b * ny + e * nz;
  a -= along * nx;
  b -= along * ny;
  e -= along * nz;
  const Real gx = damp.ct * tx, gy = damp.ct * ty, gz = damp.ct * tz;
  Real fx = c.kt * a + gx, fy = c.kt * b + gy, fz = c.kt * e + gz;
  const Real f2 = fx * fx + fy * fy + fz * fz, limit = c.mu * S::abs(fn);
  const auto sliding = S::less(limit * limit, f2);
  if (S::any(sliding)) {
    const Real cut = S::select(sliding, limit / S::sqrt(f2), S::set(1.0));
    fx = fx * cut;
    fy = fy * cut;
    fz = fz * cut;
    a = S::select(sliding, (fx - gx) * c.inverse_kt, a);
    b = S::select(sliding, (fy - gy) * c.inverse_kt, b);
    e = S::select(sliding, (fz - gz) * c.inverse_kt, e);
  }
  s[0] = S::where(touching, a);
  s[1] = S::where(touching, b);
  s[2] = S::where(touching, e);
  out.fx = fn * nx + fx;
  out.fy = fn * ny + fy;
  out.fz = fn * nz + fz;
  out.tx = ny * fz - nz * fy;
  out.ty = nz * fx - nx * fz;
  out.tz = nx * fy - ny * fx;
  out.size = S::abs(fn) + limit;
  return touching;
}

}  // namespace barchan
