#pragma once

#include <array>
#include <optional>
#include <string>

#include <barchan/core/laws/contact.hpp>
#include <barchan/core/laws/contact_constants.hpp>
#include <barchan/core/laws/history.hpp>
#include <barchan/core/laws/law_key.hpp>

namespace barchan {

/// Elastic spheres: Hertz along the normal, Mindlin across it, Coulomb friction. Written once for
/// one, four or eight pairs (S: simd/*.hpp).
///
///   a  = sqrt(R·overlap)                      radius of the contact; 1/R = 1/r_i + 1/r_j
///   c  = alpha·sqrt(m_eff·4/3·E*·a)
///   fn = min(cap, c·vn − 4/3·E*·a·overlap)    cap = 0: the contact never pulls; +inf: it may
///   f' = f·min(growth, a/a_old) + 8·G*·a·vt·dt
///   ft = f' + ratio·c·vt,  |ft| <= mu·|fn|    where friction slides, f' is cut back to the limit
///
/// With growth = 1 the force of the spring goes down with the area of a contact that unloads, and
/// does not come back with it (mindlin); with growth = +inf it is 8·G*·a times the displacement
/// (mindlin-displacement). A wall is flat: 1/r = 0.
/// Sources: Hertz 1882, doi:10.1515/crll.1882.92.156; Mindlin 1949, doi:10.1115/1.4009973;
/// Thornton, Cummins & Cleary 2013, doi:10.1016/j.powtec.2012.08.012 (growth); Tsuji, Tanaka &
/// Ishida 1992, doi:10.1016/0032-5910(92)88030-L (c).
struct HertzMindlin {
  static constexpr const char* kName = "hertz";
  /// Disks of unit thickness have no Hertz law.
  static constexpr bool kIsForDisks = false, kRolls = false, kSticks = false;

  // ---- what a deck says of a pair of materials (hertz_mindlin.cpp)

  using Pair = ContactConstants;
  static constexpr int kNumKeys = 6;
  static const std::array<LawKey, kNumKeys> kKeys;
  static const auto& keys() { return kKeys; }
  /// A [[pair]] changes some of what follows from its two materials.
  static constexpr bool kPairsStandAlone = false;

  template <class P, class Visit>
  static void for_each_number(P& p, Visit&& visit) {
    visit("young_modulus", p.young_star);
    visit("poisson_ratio", p.shear_star);
    visit("friction", p.mu);
    visit("restitution", p.alpha);
    visit("tangential_damping_ratio", p.tangential_ratio);
  }
  /// What a material still has to say; none: nothing.
  static std::optional<KeyGap> find_gap(const Pair& material);
  /// What a pair that meets lacks, a key; null: nothing.
  static const char* lacking(const Pair& p) { return p.restitution ? nullptr : "restitution"; }
  /// E* and G* of two materials; of one with itself, too.
  static std::optional<Pair> mix(const Pair& a, const Pair& b);
  /// Turns a restitution into the dashpot that rebounds with it.
  static void solve(Pair& p, const ContactRules& rules);

  // ---- what `check` prints of it
  static constexpr const char* kColumns[] = {"E* [Pa]", "G* [Pa]", "alpha", "friction"};
  static std::array<std::string, 4> texts(const Pair& p);
  static double restitution(const Pair& p, double reduced_mass, const ContactRules& rules);
  /// How to make contacts stiffer. @param factor  by how much
  static std::string stiffer(double stiffness, double factor);

  // ---- the stable step, and how strong a contact may be

  static constexpr bool kStiffens = true;  ///< with overlap
  static bool acts(const Pair& p) { return p.young_star > 0.0; }
  static double pressed_overlap(const Pair& p, double radius, double force);  ///< at rest [m]
  static double struck_overlap(const Pair& p, const Impact& impact);  ///< without dashpot [m]
  static double duration(const Pair& p, const Impact& impact);        ///< without dashpot [s]
  /// Along the normal, where the overlap of the impact is largest [N/m].
  static double stiffness(const Pair& p, const Impact& impact);
  static double dashpot(const Pair& p, const Impact& impact);  ///< there [N·s/m]
  static double tangential_stiffness(const Pair& p, const Impact& impact) {
    return acts(p) ? 4.0 * p.shear_star / p.young_star * stiffness(p, impact) : 0.0;
  }
  static double tangential_stiffness(const double* row, const Overlap& overlap);
  template <class Add>
  static void for_each_motion(const Pair& p, const Impact& impact, double spin_gain, Add&& add) {
    const double k = stiffness(p, impact), c = dashpot(p, impact), m = impact.mass;
    add("contact", m, k, 0.0);
    if (c > 0.0) add("damping", m, k, c);
    if (p.mu > 0.0)
      add("tangential", m / (1.0 + spin_gain), tangential_stiffness(p, impact),
          p.tangential_ratio * c);
  }
  /// How long a wave along the surface of a particle takes to run around half of it [s]; 0 where
  /// that is not known.
  static double wave_time(const Pair& of_material, double radius, double density);
  static double largest_force(const Pair& p, double share, double overlap, const Impact& impact);

  // ---- what kernels read: one row of numbers a pair of materials

  enum Field { Kn, Kt, Mu, Damping, TangentialRatio, Cap, Growth, kNumFields };
  static void write(const Pair& p, const ContactRules& rules, double* row);
  enum Level { Only, kNumLevels };
  static Level level(const Pair& /*p*/) { return Only; }
  static constexpr int fields_read(int /*level*/) { return kNumFields; }
  static constexpr bool is_common(int field) { return field == Cap || field == Growth; }

  template <class S>
  struct Constants {
    using Real = typename S::Real;
    Real kn, kt;  ///< 4/3·E*, 8·G* [Pa]
    Real mu;
    Real damping;  ///< alpha·sqrt(4/3·E*)
    Real tangential_ratio;
    Real cap, growth;
  };

  // ---- the law

  /// The force of the tangential spring [N] and the radius of the contact [m]; nothing without
  /// friction.
  template <int Dim>
  static constexpr History kHistory = Dim == 2 ? History{} : History{4, 0b0111};
  template <class S, int Dim>
  using Force = PairForce<S, Dim>;
  template <class S, int Dim>
  using State = PairState<S, Dim>;

  /// Stored in a contact [J]; in one that slid or turned, what its tangential force would give
  /// back.
  static double energy(const double* row, const History& history, const Overlap& overlap,
                       const double* numbers);

  template <class S, int Level>
  [[gnu::always_inline]] static inline typename S::Mask respond(const Constants<S>& c,
                                                                const PairState<S, 3>& p,
                                                                typename S::Real dt,
                                                                typename S::Real (&s)[4],
                                                                PairForce<S, 3>& out) {
    Touch<S, 3> t;
    return touch<S, Level>(c, p, dt, s, out, t);
  }

  template <class S, int Level>
  [[gnu::always_inline]] static inline typename S::Mask touch(
      const Constants<S>& c, const PairState<S, 3>& p, typename S::Real dt,
      typename S::Real (&s)[4], PairForce<S, 3>& out, Touch<S, 3>& t) {
    return touch_of<HertzMindlin, S>(c, p, dt, s, out, t);
  }

  /// What adhesion goes by; `elastic` is Hertz's force.
  template <class S>
  struct Pressed {
    typename S::Real radius, overlap, d, inverse, reach, elastic;
  };
  /// Hertz contacts do not stick.
  template <class S>
  [[gnu::always_inline]] static inline void adhere(const Constants<S>& /*c*/,
                                                   const Pressed<S>& /*x*/,
                                                   typename S::Real& /*fn*/,
                                                   typename S::Real& /*pressed*/) {}

 protected:
  /// @tparam Law  this one, or one that sticks, which adds to fn
  template <class Law, class S>
  [[gnu::always_inline]] static inline typename S::Mask touch_of(
      const typename Law::template Constants<S>& c, const PairState<S, 3>& p, typename S::Real dt,
      typename S::Real (&s)[4], PairForce<S, 3>& out, Touch<S, 3>& t) {
    using Real = typename S::Real;
    const Real zero = S::set(0.0);
    const Real d2 = p.dx * p.dx + p.dy * p.dy + p.dz * p.dz;
    const auto touching = S::less(d2, p.reach * p.reach);
    if (!S::any(touching)) {
      s[0] = s[1] = s[2] = s[3] = zero;
      return touching;
    }
    const Real d = S::sqrt(d2), overlap = p.reach - d;
    const Real both = p.inverse_mass * p.inverse_radius;  // one division for 1/d, R and m_eff
    const Real q = S::set(1.0) / (d * both);
    const Real inverse = q * both, radius = q * (d * p.inverse_mass),
               mass = q * (d * p.inverse_radius);
    const Real nx = p.dx * inverse, ny = p.dy * inverse, nz = p.dz * inverse;
    const Real vn = p.vx * nx + p.vy * ny + p.vz * nz;
    const Real a = S::sqrt(radius * overlap);
    const Real damping = c.damping * S::sqrt(mass * a);
    const Real elastic = c.kn * a * overlap;
    const Real normal = damping * vn - elastic;
    Real fn = S::select(S::less(c.cap, normal), c.cap, normal);
    Real pressed = S::abs(fn);
    Law::template adhere<S>(c, {radius, overlap, d, inverse, p.reach, elastic}, fn, pressed);

    const Real tx = p.vx - vn * nx - (p.uy * nz - p.uz * ny);
    const Real ty = p.vy - vn * ny - (p.uz * nx - p.ux * nz);
    const Real tz = p.vz - vn * nz - (p.ux * ny - p.uy * nx);
    // A new contact has the radius zero and no force; its quotient is no number that counts.
    const Real grown = S::select(S::less(zero, s[3]), a / s[3], zero);
    const Real scale = S::select(S::less(c.growth, grown), c.growth, grown);
    const Real stretch = c.kt * a * dt;
    Real fx = scale * s[0] + stretch * tx, fy = scale * s[1] + stretch * ty,
         fz = scale * s[2] + stretch * tz;
    const Real along = fx * nx + fy * ny + fz * nz;
    fx -= along * nx;
    fy -= along * ny;
    fz -= along * nz;
    const Real viscous = c.tangential_ratio * damping;
    const Real gx = viscous * tx, gy = viscous * ty, gz = viscous * tz;
    Real hx = fx + gx, hy = fy + gy, hz = fz + gz;
    const Real h2 = hx * hx + hy * hy + hz * hz, limit = c.mu * pressed;
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
    s[0] = S::where(touching, fx);
    s[1] = S::where(touching, fy);
    s[2] = S::where(touching, fz);
    s[3] = S::where(touching, S::select(S::less(zero, c.kt), a, zero));
    out.fx = fn * nx + hx;
    out.fy = fn * ny + hy;
    out.fz = fn * nz + hz;
    out.tx = ny * hz - nz * hy;
    out.ty = nz * hx - nx * hz;
    out.tz = nx * hy - ny * hx;
    out.size = S::abs(fn) + limit;
    t = {pressed, c.kt * a, viscous, overlap, nx, ny, nz};
    return touching;
  }
};

}  // namespace barchan
