#pragma once

#include <barchan/core/laws/contact.hpp>

namespace barchan {

template <class S>
[[gnu::always_inline]] inline typename S::Real square(typename S::Real a) {
  return a * a;
}

/// Two spheres at a distance d, as laws of elastic spheres see them.
template <class S>
struct Pairing {
  using Real = typename S::Real;
  Real inverse;       ///< 1/d
  Real nx, ny, nz;    ///< from the first to the second
  Real radius, mass;  ///< reduced [m, kg]
  Real vn;            ///< along the normal [m/s]
  Real tx, ty, tz;    ///< of the surfaces against each other, across it [m/s]

  [[gnu::always_inline]] inline Pairing(const PairState<S, 3>& p, Real d) {
    const Real both = p.inverse_mass * p.inverse_radius;  // one division for 1/d, R and m_eff
    const Real q = S::set(1.0) / (d * both);
    inverse = q * both;
    radius = q * (d * p.inverse_mass);
    mass = q * (d * p.inverse_radius);
    nx = p.dx * inverse, ny = p.dy * inverse, nz = p.dz * inverse;
    vn = p.vx * nx + p.vy * ny + p.vz * nz;
    tx = p.vx - vn * nx - (p.uy * nz - p.uz * ny);
    ty = p.vy - vn * ny - (p.uz * nx - p.ux * nz);
    tz = p.vz - vn * nz - (p.ux * ny - p.uy * nx);
  }

  /// @param fn  along the normal, h  across it [N]
  [[gnu::always_inline]] inline void act(Real fn, const Real (&h)[3], PairForce<S, 3>& out) const {
    out.fx = fn * nx + h[0];
    out.fy = fn * ny + h[1];
    out.fz = fn * nz + h[2];
    out.tx = ny * h[2] - nz * h[1];
    out.ty = nz * h[0] - nx * h[2];
    out.tz = nx * h[1] - ny * h[0];
  }
};

/// Mindlin's tangential spring with a dashpot and Coulomb's limit, see HertzMindlin.
/// @param c  kt (8·G*) and growth
/// @param a, a_old  radius of the contact, now and one step before; zero in a new one [m]
/// @param f  force of the spring [N], replaced by its value after the step
/// @param h  tangential force on the first [N]
template <class S, class Constants>
[[gnu::always_inline]] inline void mindlin(const Constants& c, const Pairing<S>& p,
                                           typename S::Real a, typename S::Real a_old,
                                           typename S::Real viscous, typename S::Real limit,
                                           typename S::Real dt, typename S::Real (&f)[3],
                                           typename S::Real (&h)[3]) {
  using Real = typename S::Real;
  const Real zero = S::set(0.0);
  // A new contact has the radius zero and no force; its quotient is no number that counts.
  const Real grown = S::select(S::less(zero, a_old), a / a_old, zero);
  const Real scale = S::select(S::less(c.growth, grown), c.growth, grown);
  const Real stretch = c.kt * a * dt;
  Real fx = scale * f[0] + stretch * p.tx, fy = scale * f[1] + stretch * p.ty,
       fz = scale * f[2] + stretch * p.tz;
  const Real along = fx * p.nx + fy * p.ny + fz * p.nz;
  fx -= along * p.nx;
  fy -= along * p.ny;
  fz -= along * p.nz;
  const Real gx = viscous * p.tx, gy = viscous * p.ty, gz = viscous * p.tz;
  Real hx = fx + gx, hy = fy + gy, hz = fz + gz;
  const Real h2 = hx * hx + hy * hy + hz * hz;
  const auto sliding = S::less(limit * limit, h2);
  if (S::any(sliding)) {
    const Real cut = S::select(sliding, limit / S::sqrt(h2), S::set(1.0));
    hx = hx * cut;
    hy = hy * cut;
    hz = hz * cut;
    fx = S::select(sliding, hx - gx, fx);
    fy = S::select(sliding, hy - gy, fy);
    fz = S::select(sliding, hz - gz, fz);
  }
  f[0] = fx, f[1] = fy, f[2] = fz;
  h[0] = hx, h[1] = hy, h[2] = hz;
}

}  // namespace barchan
