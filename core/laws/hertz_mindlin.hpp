#pragma once

#include <array>
#include <optional>
#include <string>

#include <barchan/core/laws/contact.hpp>
#include <barchan/core/laws/contact_constants.hpp>
#include <barchan/core/laws/history.hpp>
#include <barchan/core/laws/law_key.hpp>
#include <barchan/core/laws/losses.hpp>
#include <barchan/core/laws/mindlin.hpp>

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
struct HertzMindlin : RespondsByTouch<HertzMindlin> {
  static constexpr const char* kName = "hertz";
  /// Disks of unit thickness have no Hertz law.
  static constexpr bool kIsForDisks = false, kRolls = false;
  static constexpr bool kIsByRadius = false;
  static constexpr const char* kChoice = "model = \"hertz\"";  ///< in [contact]
  static constexpr bool sticks_by(Adhesion adhesion) { return adhesion == Adhesion::None; }

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
  static constexpr bool kKeepsForce = true;  ///< in its history
  static KeptContact kept_contact(const double* row, const double* numbers,
                                  const KeptContact& /*now*/) {
    const double a = numbers[3] > 0.0 ? numbers[3] : 0.0;
    return {row[Kt] * a, a * a};
  }
  /// Of a pair that overlaps as it does now [s]. @param mass  reduced [kg]
  static double stable_step(const double* row, const Overlap& overlap, double mass,
                            double spin_gain) {
    return stable_step_of(row, area(row, overlap), mass, spin_gain);
  }
  /// Squared radius of a contact, zero where it holds from afar [m²].
  static double area(const double* /*row*/, const Overlap& overlap) {
    return overlap.depth > 0.0 ? overlap.depth / overlap.inverse_radius : 0.0;
  }
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
  static double stable_step_of(const double* row, double area, double mass, double spin_gain);

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
    const Pairing<S> pair(p, d);
    const Real a = S::sqrt(pair.radius * overlap);
    const Real damping = c.damping * S::sqrt(pair.mass * a);
    const Real elastic = c.kn * a * overlap;
    const Real normal = damping * pair.vn - elastic;
    Real fn = S::select(S::less(c.cap, normal), c.cap, normal);
    Real pressed = S::abs(fn);
    Law::template adhere<S>(c, {pair.radius, overlap, d, pair.inverse, p.reach, elastic}, fn,
                            pressed);
    const Real limit = c.mu * pressed, viscous = c.tangential_ratio * damping;
    Real f[3] = {s[0], s[1], s[2]}, h[3];
    mindlin<S>(c, pair, a, s[3], viscous, limit, dt, f, h);
    for (int q = 0; q < 3; ++q) s[q] = S::where(touching, f[q]);
    s[3] = S::where(touching, S::select(S::less(zero, c.kt), a, zero));
    pair.act(fn, h, out);
    out.size = S::abs(fn) + limit;
    t = {pressed, c.kt * a, viscous, limit,   pair.radius * overlap,
         pair.nx, pair.ny,  pair.nz, touching};
    return touching;
  }
};

}  // namespace barchan
