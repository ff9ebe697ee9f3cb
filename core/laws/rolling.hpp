#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string>

#include <barchan/core/laws/contact.hpp>
#include <barchan/core/laws/contact_constants.hpp>
#include <barchan/core/laws/history.hpp>
#include <barchan/core/laws/law_key.hpp>
#include <barchan/core/laws/stable_step.hpp>

namespace barchan {

/// What a deck says of rolling, for any base (rolling.cpp).
struct RollingPart {
  static constexpr int kNumKeys = 4;
  static const std::array<LawKey, kNumKeys> kKeys;
  /// Mixes into a pair that has the other numbers. @return false where two ways do not mix
  static bool mix(const ContactConstants& a, const ContactConstants& b, ContactConstants& pair);
  enum Field { Stiffness, StiffnessRatio, Damping, Friction, Twisting, kNumFields };
  static void write(const ContactConstants& p, const ContactRules& rules, double* fields);
  static std::string text(const ContactConstants& p);
};

/// A law of contact that also resists rolling and, in 3D, twisting. What is not said here is as in
/// the base.
/// With w = omega_j − omega_i, 1/R = 1/r_i + 1/r_j and, of the base, fn, kt and ct:
///
///   x' = x + R·w×n·dt                  rolling spring, zero at first touch; in the plane across n
///   f  = kr·x' + cr·R·w×n,  |f| <= mu_r·|fn|        kr = stiffness + ratio·kt
///   M  = R·n×f                         couple on i, −M on j; where it slips, x' is cut back
///
///   y' = y + w·n·dt                    twisting: a² = R·overlap
///   Q  = a²/2·(kt·y' + ct·w·n)·n,  |Q| <= 2/3·a·mu·|fn|        on i, −Q on j
///
/// Sources: Iwashita & Oda 1998, doi:10.1061/(ASCE)0733-9399(1998)124:3(285), and Luding 2008,
/// doi:10.1007/s10035-008-0099-x (rolling; with kr = kt and cr = 0 it is EPSD2 of LIGGGHTS, else
/// SDS of LAMMPS); Marshall 2009, doi:10.1016/j.jcp.2008.10.020 (twisting).
template <class Base>
struct WithRolling : Base {
  static constexpr bool kRolls = true;

  // ---- what a deck says of a pair of materials

  using Pair = ContactConstants;
  static constexpr int kNumKeys = Base::kNumKeys + RollingPart::kNumKeys;
  static const auto& keys() {
    static const auto all = joined_keys(Base::keys(), RollingPart::kKeys);
    return all;
  }
  template <class P, class Visit>
  static void for_each_number(P& p, Visit&& visit) {
    Base::for_each_number(p, visit);
    visit("rolling_friction", p.mu_rolling);
    visit("rolling_stiffness", p.kr);
    visit("rolling_stiffness_ratio", p.kr_ratio);
    visit("rolling_damping", p.cr);
  }
  static std::optional<Pair> mix(const Pair& a, const Pair& b) {
    auto mixed = Base::mix(a, b);
    if (mixed && !RollingPart::mix(a, b, *mixed)) return std::nullopt;
    return mixed;
  }

  // ---- what `check` prints of it
  static constexpr int kBaseColumns = static_cast<int>(std::size(Base::kColumns));
  static constexpr auto kColumns = [] {
    std::array<const char*, kBaseColumns + 1> columns{};
    for (int c = 0; c < kBaseColumns; ++c) columns[c] = Base::kColumns[c];
    columns[kBaseColumns] = "rolling";
    return columns;
  }();
  static std::array<std::string, kBaseColumns + 1> texts(const Pair& p) {
    const auto base = Base::texts(p);
    std::array<std::string, kBaseColumns + 1> all;
    for (int c = 0; c < kBaseColumns; ++c) all[c] = base[c];
    all[kBaseColumns] = RollingPart::text(p);
    return all;
  }
  // ---- the stable step, and how strong a contact may be

  /// Rolling moves at least the mass m_eff·(I/(m·r²)): on a wall, where the couple turns one alone.
  template <class Add>
  static void for_each_motion(const Pair& p, const Impact& impact, double spin_gain, Add&& add) {
    Base::for_each_motion(p, impact, spin_gain, add);
    if (p.mu_rolling > 0.0)
      add("rolling", impact.mass / spin_gain,
          p.kr + p.kr_ratio * Base::tangential_stiffness(p, impact), p.cr);
  }
  static double stable_step(const double* row, const Overlap& overlap, double mass,
                            double spin_gain) requires(Base::kStiffens) {
    const double *more = row + kFirst, kt = Base::tangential_stiffness(row, overlap);
    const double base = Base::stable_step(row, overlap, mass, spin_gain);
    if (more[RollingPart::Friction] == 0.0) return base;
    return std::min(base, barchan::stable_step(
                              mass / spin_gain,
                              more[RollingPart::Stiffness] + more[RollingPart::StiffnessRatio] * kt,
                              more[RollingPart::Damping]));
  }
  static double largest_force(const Pair& p, double share, double overlap, const Impact& impact) {
    return (1.0 + 2.0 * (p.mu_rolling + p.mu)) * Base::largest_force(p, share, overlap, impact);
  }

  // ---- what kernels read: the row of the base, and what is added

  static constexpr int kFirst = Base::kNumFields;
  static constexpr int kNumFields = kFirst + RollingPart::kNumFields;
  static void write(const Pair& p, const ContactRules& rules, double* row) {
    Base::write(p, rules, row);
    RollingPart::write(p, rules, row + kFirst);
  }
  enum Level { Only, kNumLevels };
  static Level level(const Pair& /*p*/) { return Only; }
  static constexpr int kBaseLevel = Base::kNumLevels - 1;
  static constexpr int fields_read(int /*level*/) { return kNumFields; }
  static constexpr bool is_common(int field) { return field < kFirst && Base::is_common(field); }

  template <class S>
  struct Constants {
    using Real = typename S::Real;
    typename Base::template Constants<S> base;
    Real kr, kr_ratio, cr, mu_rolling;
    Real twisting;  ///< 1 or 0
  };

  // ---- the law

  template <int Dim>
  static constexpr int kKept = Base::template kHistory<Dim>.length;
  /// After the base's: in 2D the rolling spring [m], which flips; in 3D its three components, which
  /// do not, and the twist [rad].
  template <int Dim>
  static constexpr History kHistory =
      !Base::kIsForDisks && Dim == 2 ? History{}
      : Dim == 2 ? History{kKept<2> + 1, Base::template kHistory<2>.flips | 1U << kKept<2>}
                 : History{kKept<3> + 4, Base::template kHistory<3>.flips};
  template <class S, int Dim>
  using Force = PairForces<S, Dim>;
  template <class S, int Dim>
  using State = TurningPair<S, Dim>;

  static double energy(const double* row, const History& history, const Overlap& overlap,
                       const double* numbers) {
    const bool is_flat = history.length == kHistory<2>.length;
    const History base = is_flat ? Base::template kHistory<2> : Base::template kHistory<3>;
    const double* more = numbers + base.length;
    const double kt = Base::tangential_stiffness(row, overlap);
    const double kr =
        row[kFirst + RollingPart::Stiffness] + row[kFirst + RollingPart::StiffnessRatio] * kt;
    double x2 = 0.0;
    for (int c = 0; c < (is_flat ? 1 : 3); ++c) x2 += more[c] * more[c];
    double sum = Base::energy(row, base, overlap, numbers) + 0.5 * kr * x2;
    if (!is_flat)
      sum += 0.25 * row[kFirst + RollingPart::Twisting] * kt * Base::area(row, overlap) * more[3] *
             more[3];
    return sum;
  }

  template <class S, int Level>
  [[gnu::always_inline]] static inline typename S::Mask respond(const Constants<S>& c,
                                                                const TurningPair<S, 2>& p,
                                                                typename S::Real dt,
                                                                typename S::Real (&h)[kKept<2> + 1],
                                                                PairForces<S, 2>& out) {
    using Real = typename S::Real;
    Real& kept = h[kKept<2>];
    Touch<S, 2> t;
    const auto touching = respond_of_base<S, 2>(c, p, dt, h, out.first, t);
    if (!S::any(touching)) {
      kept = S::set(0.0);
      return touching;
    }
    const Real radius = S::set(1.0) / p.inverse_radius;
    const Real rate = radius * p.turn, viscous = c.cr * rate;
    const Real stiffness = c.kr + c.kr_ratio * t.kt;
    const Real stretched = kept + rate * dt;
    const Real sticking = stiffness * stretched + viscous;
    const Real limit = c.mu_rolling * t.pressed;
    const auto slipping = S::less(limit, S::abs(sticking));
    const Real f = S::select(slipping, S::copysign(limit, sticking), sticking);
    const Real cut = (f - viscous) * inverse_or_zero<S>(stiffness);
    kept = keep<S>(touching, c, S::select(slipping, cut, stretched));
    const Real couple = radius * f;
    out.first.size = out.first.size + S::abs(f);
    out.second = out.first;
    out.first.ft = out.first.ft + couple * p.inverse_first;
    out.second.ft = out.second.ft - couple * p.inverse_second;
    return touching;
  }

  template <class S, int Level>
  [[gnu::always_inline]] static inline typename S::Mask respond(const Constants<S>& c,
                                                                const TurningPair<S, 3>& p,
                                                                typename S::Real dt,
                                                                typename S::Real (&h)[kKept<3> + 4],
                                                                PairForces<S, 3>& out) {
    using Real = typename S::Real;
    Real* kept = h + kKept<3>;
    Touch<S, 3> t;
    const auto touching = respond_of_base<S, 3>(c, p, dt, h, out.first, t);
    if (!S::any(touching)) {
      kept[0] = kept[1] = kept[2] = kept[3] = S::set(0.0);
      return touching;
    }
    const Real radius = S::set(1.0) / p.inverse_radius;
    // Rolling
    const Real rx = radius * (p.turn_y * t.nz - p.turn_z * t.ny),
               ry = radius * (p.turn_z * t.nx - p.turn_x * t.nz),
               rz = radius * (p.turn_x * t.ny - p.turn_y * t.nx);
    Real x = kept[0] + rx * dt, y = kept[1] + ry * dt, z = kept[2] + rz * dt;
    const Real along = x * t.nx + y * t.ny + z * t.nz;
    x -= along * t.nx;
    y -= along * t.ny;
    z -= along * t.nz;
    const Real stiffness = c.kr + c.kr_ratio * t.kt;
    const Real gx = c.cr * rx, gy = c.cr * ry, gz = c.cr * rz;
    Real fx = stiffness * x + gx, fy = stiffness * y + gy, fz = stiffness * z + gz;
    const Real f2 = fx * fx + fy * fy + fz * fz, limit = c.mu_rolling * t.pressed;
    const auto slipping = S::less(limit * limit, f2);
    if (S::any(slipping)) {
      const Real cut = S::select(slipping, limit / S::sqrt(f2), S::set(1.0));
      const Real inverse = inverse_or_zero<S>(stiffness);
      fx = fx * cut;
      fy = fy * cut;
      fz = fz * cut;
      x = S::select(slipping, (fx - gx) * inverse, x);
      y = S::select(slipping, (fy - gy) * inverse, y);
      z = S::select(slipping, (fz - gz) * inverse, z);
    }
    // Twisting
    const Real half = S::set(0.5) * c.twisting * t.area;
    const Real turn = p.turn_x * t.nx + p.turn_y * t.ny + p.turn_z * t.nz;
    const Real twist_stiffness = half * t.kt, viscous = half * t.ct * turn;
    Real twist = kept[3] + turn * dt;
    Real q = twist_stiffness * twist + viscous;
    const Real most = S::set(2.0 / 3.0) * c.twisting * S::sqrt(t.area) * t.limit;
    const auto spinning = S::less(most, S::abs(q));
    if (S::any(spinning)) {
      q = S::select(spinning, S::copysign(most, q), q);
      twist = S::select(spinning, (q - viscous) * inverse_or_zero<S>(twist_stiffness), twist);
    }
    kept[0] = keep<S>(t.touching, c, x);
    kept[1] = keep<S>(t.touching, c, y);
    kept[2] = keep<S>(t.touching, c, z);
    kept[3] = S::where(t.touching, S::select(S::less(S::set(0.0), c.twisting), twist, S::set(0.0)));

    const Real mx = radius * (t.ny * fz - t.nz * fy) + q * t.nx,
               my = radius * (t.nz * fx - t.nx * fz) + q * t.ny,
               mz = radius * (t.nx * fy - t.ny * fx) + q * t.nz;
    out.first.size = out.first.size + ((S::abs(mx) + S::abs(my)) + S::abs(mz)) * p.inverse_radius;
    out.second = out.first;
    out.first.tx = out.first.tx + mx * p.inverse_first;
    out.first.ty = out.first.ty + my * p.inverse_first;
    out.first.tz = out.first.tz + mz * p.inverse_first;
    out.second.tx = out.second.tx - mx * p.inverse_second;
    out.second.ty = out.second.ty - my * p.inverse_second;
    out.second.tz = out.second.tz - mz * p.inverse_second;
    return touching;
  }

 private:
  template <class S, int Dim, int Length>
  [[gnu::always_inline]] static inline typename S::Mask respond_of_base(
      const Constants<S>& c, const TurningPair<S, Dim>& p, typename S::Real dt,
      typename S::Real (&h)[Length], PairForce<S, Dim>& out, Touch<S, Dim>& t) {
    typename S::Real numbers[kKept<Dim>];
    for (int q = 0; q < kKept<Dim>; ++q) numbers[q] = h[q];
    const auto touching = Base::template touch<S, kBaseLevel>(c.base, p, dt, numbers, out, t);
    for (int q = 0; q < kKept<Dim>; ++q) h[q] = numbers[q];
    return touching;
  }

  /// 1/k; of no stiffness 0, so that nothing is kept.
  template <class S>
  [[gnu::always_inline]] static inline typename S::Real inverse_or_zero(typename S::Real k) {
    return S::select(S::less(S::set(0.0), k), S::set(1.0) / k, S::set(0.0));
  }
  /// Of pairs that resist rolling.
  template <class S>
  [[gnu::always_inline]] static inline typename S::Real keep(typename S::Mask touching,
                                                             const Constants<S>& c,
                                                             typename S::Real x) {
    return S::where(touching, S::select(S::less(S::set(0.0), c.mu_rolling), x, S::set(0.0)));
  }
};

}  // namespace barchan
