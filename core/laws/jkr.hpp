#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>

#include <barchan/core/laws/hertz_mindlin.hpp>
#include <barchan/core/laws/mindlin.hpp>

namespace barchan {

/// Elastic spheres whose surfaces attract each other inside the contact: Johnson, Kendall & Roberts
/// along the normal, with the tangential part of HertzMindlin. What is not said here is as there.
/// With the surface energy g of a pair:
///
///   a0³ = 9·pi·g·R²/E*                       radius of a contact without load
///   s⁴ − 2/3·s = R·overlap/a0²,  a = a0·s²   the larger root
///   fn = min(cap, c·vn − 12·pi·g·R·s⁶) + 12·pi·g·R·s³     c as in HertzMindlin, 0 beyond touch
///   |ft| <= mu·|fn − 6·pi·g·R|
///
/// Two that touch hold each other until R·overlap/a0² is below `hold`: at the limit of what can be
/// pulled apart slowly (s³ = 1/6, where they hold with 5/9 of the largest pull), or at the peak of
/// the pull, 3·pi·g·R (s³ = 1/2). Contacts begin where spheres touch.
/// Sources: Johnson, Kendall & Roberts 1971, doi:10.1098/rspa.1971.0141; Thornton & Yin 1991,
/// doi:10.1016/0032-5910(91)80178-L (friction); Marshall 2009, doi:10.1016/j.jcp.2008.10.020.
struct Jkr : HertzMindlin, RespondsByTouch<Jkr> {
  static constexpr const char* kName = "jkr";
  static constexpr const char* kChoice = "model = \"jkr\"";  ///< in [contact]

  // ---- what a deck says of a pair of materials (jkr.cpp)

  static const std::array<LawKey, 1> kMoreKeys;
  static const auto& keys() {
    static const auto all = joined_keys(HertzMindlin::kKeys, kMoreKeys);
    return all;
  }
  template <class P, class Visit>
  static void for_each_number(P& p, Visit&& visit) {
    HertzMindlin::for_each_number(p, visit);
    visit("surface_energy", p.surface_energy);
  }
  static std::optional<Pair> mix(const Pair& a, const Pair& b);

  // ---- what `check` prints of it
  static constexpr const char* kColumns[] = {"E* [Pa]", "G* [Pa]", "alpha", "friction",
                                             "surface energy [J/m²]"};
  static std::array<std::string, 5> texts(const Pair& p);

  // ---- how strong a contact may be, and how far it holds
  static double largest_force(const Pair& p, double share, double overlap, const Impact& impact);
  /// Beyond touch [m]. @param radius  the largest reduced one [m]
  static double range(const Pair& p, const ContactRules& rules, double radius);

  // ---- what kernels read: one row of numbers a pair of materials

  enum Field {
    Adhesion = HertzMindlin::kNumFields,  ///< (9·pi·g/E*)^(1/3)
    Pull,                                 ///< 12·pi·g [N/m]
    Hold,
    kNumFields
  };
  static void write(const Pair& p, const ContactRules& rules, double* row);
  static constexpr int fields_read(int /*level*/) { return kNumFields; }
  static constexpr bool is_common(int field) {
    return field == Hold || (field < Adhesion && HertzMindlin::is_common(field));
  }
  template <class S>
  struct Constants {
    using Real = typename S::Real;
    typename HertzMindlin::Constants<S> hertz;
    Real adhesion, pull, hold;
  };

  // ---- the law

  using RespondsByTouch<Jkr>::respond;

  static double tangential_stiffness(const double* row, const Overlap& overlap);
  using HertzMindlin::tangential_stiffness;
  static double area(const double* row, const Overlap& overlap);
  static double stable_step(const double* row, const Overlap& overlap, double mass,
                            double spin_gain) {
    return stable_step_of(row, area(row, overlap), mass, spin_gain);
  }
  /// The radius of the contact says that it holds, with friction or without.
  static double energy(const double* row, const History& history, const Overlap& overlap,
                       const double* numbers);

  /// The larger root of s⁴ − 2/3·s = d, for d not below that of the limit. Four Newton steps from
  /// the right: 3e-15, and 5e-13 within 1e-8 of the limit, where the root turns back.
  template <class S>
  [[gnu::always_inline]] static inline typename S::Real root(typename S::Real d) {
    using Real = typename S::Real;
    const Real two_thirds = S::set(2.0 / 3.0), four = S::set(4.0);
    Real s = S::sqrt(S::set(kLeastRoot2) + S::sqrt(d - S::set(kLeast)));
    for (int step = 0; step < 4; ++step) {
      const Real s3 = s * s * s;
      s = s - ((s3 - two_thirds) * s - d) / (four * s3 - two_thirds);
    }
    return s;
  }
  /// To 7e-15: two of Halley's steps.
  template <class S>
  [[gnu::always_inline]] static inline typename S::Real cube_root(typename S::Real a) {
    using Real = typename S::Real;
    Real x = S::rough_cube_root(a);
    for (int step = 0; step < 2; ++step) {
      const Real x3 = x * x * x;
      x = x * ((x3 + (a + a)) / ((x3 + x3) + a));
    }
    return x;
  }

  template <class S, int Level>
  [[gnu::always_inline]] static inline typename S::Mask touch(
      const Constants<S>& c, const PairState<S, 3>& p, typename S::Real dt,
      typename S::Real (&s)[4], PairForce<S, 3>& out, Touch<S, 3>& t) {
    using Real = typename S::Real;
    const Real zero = S::set(0.0);
    const Real d2 = p.dx * p.dx + p.dy * p.dy + p.dz * p.dz;
    const auto was_held = S::less(zero, s[3]);
    const Real infinite = S::set(std::numeric_limits<double>::infinity());
    const auto may_hold = S::less(d2, S::select(was_held, infinite, p.reach * p.reach));
    if (!S::any(may_hold)) {
      s[0] = s[1] = s[2] = s[3] = zero;
      out = PairForce<S, 3>{};
      t = Touch<S, 3>{};
      return may_hold;
    }
    const Real d = S::sqrt(d2), overlap = p.reach - d;
    const Pairing<S> pair(p, d);
    const Real a0 = c.adhesion * square<S>(cube_root<S>(pair.radius));
    const Real load = overlap * pair.radius / (a0 * a0);
    const auto holds = S::less(S::select(was_held, c.hold, zero), load);
    if (!S::any(holds)) {
      s[0] = s[1] = s[2] = s[3] = zero;
      out = PairForce<S, 3>{};
      t = Touch<S, 3>{};
      return holds;
    }
    const Real root_of_load = root<S>(load), s3 = root_of_load * square<S>(root_of_load);
    const Real a = a0 * square<S>(root_of_load);
    const Real pull = c.pull * pair.radius, adhesive = pull * s3;
    const Real pressed = S::select(S::less(zero, overlap), overlap, zero);
    const Real damping = c.hertz.damping * S::sqrt(pair.mass * S::sqrt(pair.radius * pressed));
    const Real normal = damping * pair.vn - adhesive * s3;
    const Real fn = S::select(S::less(c.hertz.cap, normal), c.hertz.cap, normal) + adhesive;

    const Real load_on_surfaces = S::abs(fn - S::set(0.5) * pull);
    const Real limit = c.hertz.mu * load_on_surfaces;
    const Real viscous = c.hertz.tangential_ratio * damping;
    Real f[3] = {s[0], s[1], s[2]}, h[3];
    mindlin<S>(c.hertz, pair, a, s[3], viscous, limit, dt, f, h);
    for (int q = 0; q < 3; ++q) s[q] = S::where(holds, f[q]);
    s[3] = S::where(holds, S::select(S::less(zero, c.pull), a, zero));
    pair.act(fn, h, out);
    out.size = (S::abs(fn) + adhesive) + limit;
    t = {load_on_surfaces, c.hertz.kt * a, viscous, limit, a * a, pair.nx, pair.ny, pair.nz, holds};
    return holds;
  }

 private:
  static constexpr double kLeast = -0.27516060407455223;      ///< d at the limit
  static constexpr double kLeastRoot2 = 0.30285343213868998;  ///< (1/6)^(2/3)
  static constexpr double kPeak = -0.13228342099734997;       ///< d at the peak
  static double hold(const ContactRules& rules);
  struct Circle {
    double without_load, root;  ///< a0 [m], s
  };
  static Circle circle(const double* row, const Overlap& overlap);
};

}  // namespace barchan
