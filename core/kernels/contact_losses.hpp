#pragma once

#include <algorithm>
#include <cmath>

#include <barchan/core/kernels/law_view.hpp>
#include <barchan/core/laws/contact.hpp>
#include <barchan/core/laws/history.hpp>
#include <barchan/core/laws/losses.hpp>
#include <barchan/core/laws/rolling.hpp>
#include <barchan/core/particles/layout.hpp>
#include <barchan/core/simd/scalar.hpp>

// What is lost through a contact in a step, of any law that tells of its contacts by `touch`.
//
//   spring     ½·(f before + f now)·v·dt: what it stores is a loss, too, until it gives it back
//   dashpot    d·v·kick, where v is the mean over the kick, as far as the pair's own force changes
//              it; along the normal d is the force beyond that of the same contact at rest
//
// So over a whole contact nothing is left out, also of what a spring holds where a contact ends,
// and nobody has to notice that it does; what springs hold at an instant is `stored_in`. A contact
// that slides loses by sliding all that it loses across the normal. Velocities are half a step
// behind: springs have stretched by v·dt, which makes the first of second order.

namespace barchan::detail {

/// The scalar law (contact_law.hpp).
template <class Law, int Dim, int Level = 0>
PairForce<simd::Scalar, Dim> respond_at(int level, const double* row,
                                        const TurningPair<simd::Scalar, Dim>& pair, double dt,
                                        double* history);

using OnePair = simd::Scalar;

template <class Law>
struct BaseOf {
  using Type = Law;
};
template <class Base>
struct BaseOf<WithRolling<Base>> {
  using Type = Base;
};

/// A contact now: components across the normal are one along the tangent in 2D, and three in 3D.
template <int Dim>
struct Sight {
  static constexpr int kAcross = Dim == 2 ? 1 : 3;
  double n[3] = {}, vn = 0.0, fn = 0.0;
  double v[kAcross] = {}, h[kAcross] = {};
  bool slides = false;
};

inline Sight<2> sight(const PairState<OnePair, 2>& p, const PairForce<OnePair, 2>& f,
                      const Touch<OnePair, 2>& t, double friction) {
  Sight<2> s;
  const double d = std::sqrt(p.dx * p.dx + p.dy * p.dy);
  s.n[0] = p.dx / d, s.n[1] = p.dy / d;
  s.vn = p.vx * s.n[0] + p.vy * s.n[1];
  s.fn = f.fx * s.n[0] + f.fy * s.n[1];
  s.v[0] = (p.vy * s.n[0] - p.vx * s.n[1]) - p.surface;
  s.h[0] = f.ft;
  s.slides = std::abs(f.ft) >= friction * t.pressed;
  return s;
}

inline Sight<3> sight(const PairState<OnePair, 3>& p, const PairForce<OnePair, 3>& f,
                      const Touch<OnePair, 3>& t, double /*friction*/) {
  constexpr double kRounding = 1e-12;
  Sight<3> s;
  s.n[0] = t.nx, s.n[1] = t.ny, s.n[2] = t.nz;
  s.vn = p.vx * t.nx + p.vy * t.ny + p.vz * t.nz;
  s.fn = f.fx * t.nx + f.fy * t.ny + f.fz * t.nz;
  s.v[0] = p.vx - s.vn * t.nx - (p.uy * t.nz - p.uz * t.ny);
  s.v[1] = p.vy - s.vn * t.ny - (p.uz * t.nx - p.ux * t.nz);
  s.v[2] = p.vz - s.vn * t.nz - (p.ux * t.ny - p.uy * t.nx);
  s.h[0] = f.fx - s.fn * t.nx, s.h[1] = f.fy - s.fn * t.ny, s.h[2] = f.fz - s.fn * t.nz;
  const double h2 = s.h[0] * s.h[0] + s.h[1] * s.h[1] + s.h[2] * s.h[2];
  s.slides = h2 >= t.limit * t.limit * (1.0 - kRounding);
  return s;
}

inline void stop(PairState<OnePair, 2>& p) {
  p.vx = p.vy = p.surface = 0.0;
}
inline void stop(PairState<OnePair, 3>& p) {
  p.vx = p.vy = p.vz = p.ux = p.uy = p.uz = 0.0;
}

/// The base of a law, over a step.
template <class Base, int Dim>
struct BaseContact {
  static constexpr int kLength = Base::template kHistory<Dim>.length;
  static constexpr int kLevel = Base::kNumLevels - 1;  // a pair gives the same bits at any
  typename Base::template Constants<OnePair> constants;
  PairForce<OnePair, Dim> force{};
  Touch<OnePair, Dim> touch{};
  double before[kLength], now[kLength];
  bool holds = false;

  BaseContact(const double* row, const PairState<OnePair, Dim>& p, double dt, const double* history)
      : constants(constants_from<Base, OnePair>([row](auto f) { return row[f.kPlace]; },
                                                FieldsOf<Base>{})) {
    std::copy_n(history, kLength, before);
    std::copy_n(history, kLength, now);
    holds = Base::template touch<OnePair, kLevel>(constants, p, dt, now, force, touch);
  }
  [[nodiscard]] Sight<Dim> sight_of(const PairState<OnePair, Dim>& p) const {
    double friction = 0.0;
    if constexpr (Dim == 2) friction = constants.mu;
    return sight(p, force, touch, friction);
  }
  /// Along the normal, of the same contact at rest [N].
  [[nodiscard]] double force_at_rest(PairState<OnePair, Dim> p, const Sight<Dim>& s) const {
    stop(p);
    double kept[kLength];
    std::copy_n(before, kLength, kept);
    PairForce<OnePair, Dim> f{};
    Touch<OnePair, Dim> t{};
    Base::template touch<OnePair, kLevel>(constants, p, 0.0, kept, f, t);
    const double in_plane = f.fx * s.n[0] + f.fy * s.n[1];
    if constexpr (Dim == 3) return in_plane + f.fz * s.n[2];
    return in_plane;
  }
};

template <class Base, int Dim>
void add_base_losses(const double* row, const BaseContact<Base, Dim>& c,
                     const PairState<OnePair, Dim>& p, const LossTimes& times, Losses& to) {
  const Sight<Dim> s = c.sight_of(p);
  const double half_kick = 0.5 * times.kick * p.inverse_mass;
  to.dashpots += (s.fn - c.force_at_rest(p, s)) * (s.vn - half_kick * s.fn) * times.kick;
  const double k = c.touch.kt;
  const double k_old = Base::kept_contact(row, c.before, {k, 0.0}).kt;
  double slipped = 0.0, damped = 0.0;
  for (int q = 0; q < Sight<Dim>::kAcross; ++q) {
    const double f = (Base::kKeepsForce ? 1.0 : k) * c.now[q];
    const double f_old = (Base::kKeepsForce ? 1.0 : k_old) * c.before[q];
    slipped += 0.5 * (f_old + f) * s.v[q] * times.stretch;
    const double v = s.v[q] - half_kick * (1.0 + Layout<Dim>::kSpinGain) * s.h[q];
    damped += (s.h[q] - f) * v * times.kick;
  }
  to.sliding += slipped + (s.slides ? damped : 0.0);
  to.dashpots += s.slides ? 0.0 : damped;
}

/// How fast a pair rolls, R·w×n, and twists.
inline void turns_of(const TurningPair<OnePair, 2>& p, const Touch<OnePair, 2>& /*t*/,
                     double radius, double (&roll)[1], double& twist) {
  roll[0] = radius * p.turn;
  twist = 0.0;
}
inline void turns_of(const TurningPair<OnePair, 3>& p, const Touch<OnePair, 3>& t, double radius,
                     double (&roll)[3], double& twist) {
  roll[0] = radius * (p.turn_y * t.nz - p.turn_z * t.ny);
  roll[1] = radius * (p.turn_z * t.nx - p.turn_x * t.nz);
  roll[2] = radius * (p.turn_x * t.ny - p.turn_y * t.nx);
  twist = p.turn_x * t.nx + p.turn_y * t.ny + p.turn_z * t.nz;
}

/// @param more  the numbers and fields that rolling adds, before and after the step
template <class Base, int Dim>
void add_rolling_losses(const double* row, const BaseContact<Base, Dim>& c,
                        const TurningPair<OnePair, Dim>& p, const LossTimes& times,
                        const double* before, const double* now, Losses& to) {
  using F = RollingPart;
  const double* more = row + WithRolling<Base>::kFirst;
  const double radius = 1.0 / p.inverse_radius;
  double roll[Sight<Dim>::kAcross], twist = 0.0;
  turns_of(p, c.touch, radius, roll, twist);
  double area = 0.0;
  if constexpr (Dim == 3) area = c.touch.area;
  const KeptContact old = Base::kept_contact(row, c.before, {c.touch.kt, area});
  const auto stiffness_at = [&](double kt) {
    return more[F::Stiffness] + more[F::StiffnessRatio] * kt;
  };
  const double k = stiffness_at(c.touch.kt), k_old = stiffness_at(old.kt);
  double f[Sight<Dim>::kAcross], f2 = 0.0;
  for (int q = 0; q < Sight<Dim>::kAcross; ++q) {
    to.rolling += 0.5 * (k_old * before[q] + k * now[q]) * roll[q] * times.stretch;
    f[q] = k * now[q] + more[F::Damping] * roll[q];
    f2 += f[q] * f[q];
  }
  const double limit = more[F::Friction] * c.touch.pressed;
  const double cut = f2 > limit * limit ? limit / std::sqrt(f2) : 1.0;
  for (int q = 0; q < Sight<Dim>::kAcross; ++q)
    to.rolling += (cut * f[q] - k * now[q]) * roll[q] * times.kick;
  if constexpr (Dim == 3) {
    if (more[F::Twisting] == 0.0) return;
    const double k_twist = 0.5 * area * c.touch.kt;
    const double k_twist_old = 0.5 * old.area * old.kt;
    to.rolling += 0.5 * (k_twist_old * before[3] + k_twist * now[3]) * twist * times.stretch;
    const double viscous = 0.5 * area * c.touch.ct * twist;
    const double most = 2.0 / 3.0 * std::sqrt(area) * c.touch.limit;
    const double q = std::clamp(k_twist * now[3] + viscous, -most, most);
    to.rolling += (q - k_twist * now[3]) * twist * times.kick;
  }
}

/// Of a contact that holds after the step; of others nothing.
/// @param history  before the step
template <class Law, int Dim>
Losses losses_at(int level, const double* row, const TurningPair<OnePair, Dim>& pair,
                 const LossTimes& times, const double* history) {
  using Base = typename BaseOf<Law>::Type;
  Losses losses;
  const BaseContact<Base, Dim> contact(row, pair, times.stretch, history);
  if (!contact.holds) return losses;
  add_base_losses(row, contact, static_cast<const PairState<OnePair, Dim>&>(pair), times, losses);
  if constexpr (Law::kRolls) {
    double now[kMostHistory];
    std::copy_n(history, Law::template kHistory<Dim>.length, now);
    (void)respond_at<Law, Dim, 0>(level, row, pair, times.stretch, now);
    constexpr int kKept = BaseContact<Base, Dim>::kLength;
    add_rolling_losses<Base>(row, contact, pair, times, history + kKept, now + kKept, losses);
  }
  return losses;
}

/// What the tangential spring stores, as sliding, and those of rolling and twisting [J].
/// @param history  of a contact that holds
template <class Law, int Dim>
Losses stored_in(const double* row, const Overlap& overlap, const double* history) {
  using Base = typename BaseOf<Law>::Type;
  constexpr History kForm = Base::template kHistory<Dim>;
  double relaxed[kMostHistory];
  std::copy_n(history, kForm.length, relaxed);
  std::fill_n(relaxed, Sight<Dim>::kAcross, 0.0);
  const double base = Base::energy(row, kForm, overlap, history);
  Losses stored;
  stored.sliding = base - Base::energy(row, kForm, overlap, relaxed);
  if constexpr (Law::kRolls)
    stored.rolling = Law::energy(row, Law::template kHistory<Dim>, overlap, history) - base;
  return stored;
}

}  // namespace barchan::detail
