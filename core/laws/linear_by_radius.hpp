#pragma once

#include <array>
#include <optional>
#include <string>

#include <barchan/core/laws/linear_spring.hpp>

namespace barchan {

/// Linear contacts whose springs follow from an elastic modulus and the radii. What is not said
/// here is as in LinearSpring.
///
///   kn = 2·E·R,  kt = ratio·kn                E: harmonic mean; 1/R = 1/r_i + 1/r_j
///   cn = 2·zeta·sqrt(m_eff·kn),  ct = ratio_t·cn         zeta from the restitution
///
/// So two equal spheres have kn = E·r, and a particle at a wall, which is flat, 2·E·r.
/// Source: Šmilauer et al., Yade documentation, doi:10.5281/zenodo.5705394.
struct LinearByRadius : LinearSpring {
  static constexpr bool kIsByRadius = true;
  static constexpr const char* kChoice = "stiffness = \"radius\"";  ///< in [contact]

  // ---- what a deck says of a pair of materials (linear_by_radius.cpp)

  static constexpr int kNumKeys = 5;
  static const std::array<LawKey, kNumKeys> kKeys;
  static const auto& keys() { return kKeys; }
  /// A [[pair]] changes some of what follows from its two materials.
  static constexpr bool kPairsStandAlone = false;
  static std::optional<KeyGap> find_gap(const Pair& material);
  static const char* lacking(const Pair& p) { return p.restitution ? nullptr : "restitution"; }

  template <class P, class Visit>
  static void for_each_number(P& p, Visit&& visit) {
    visit("young_modulus", p.young_star);
    visit("friction", p.mu);
    visit("tangential_stiffness_ratio", p.kt_ratio);
    visit("restitution", p.cn.critical);
    visit("tangential_damping_ratio", p.tangential_ratio);
  }
  static std::optional<Pair> mix(const Pair& a, const Pair& b);
  static void solve(Pair& p, const ContactRules& rules);

  // ---- what `check` prints of it
  static constexpr const char* kColumns[] = {"E [Pa]", "kt/kn", "cn [N·s/m]", "ct/cn", "friction"};
  static std::array<std::string, 5> texts(const Pair& p);
  static double restitution(const Pair& p, double /*reduced_mass*/, const ContactRules& /*rules*/) {
    return p.restitution.value_or(1.0);
  }
  static std::string stiffer(double stiffness, double factor);

  // ---- the stable step, and how strong a contact may be: by the springs of a reduced radius

  static bool acts(const Pair& p) { return p.young_star > 0.0; }
  static Pair at(const Pair& p, double radius);
  static double pressed_overlap(const Pair& p, double radius, double force) {
    return LinearSpring::pressed_overlap(at(p, radius), radius, force);
  }
  static double struck_overlap(const Pair& p, const Impact& impact) {
    return LinearSpring::struck_overlap(at(p, impact.radius), impact);
  }
  static double duration(const Pair& p, const Impact& impact) {
    return LinearSpring::duration(at(p, impact.radius), impact);
  }
  static double stiffness(const Pair& p, const Impact& impact) { return at(p, impact.radius).kn; }
  static double dashpot(const Pair& p, const Impact& impact) {
    return LinearSpring::dashpot(at(p, impact.radius), impact);
  }
  static double tangential_stiffness(const Pair& p, const Impact& impact) {
    return at(p, impact.radius).kt;
  }
  static double tangential_stiffness(const double* row, const Overlap& overlap) {
    return row[Kt] / overlap.inverse_radius;
  }
  template <class Add>
  static void for_each_motion(const Pair& p, const Impact& impact, double spin_gain, Add&& add) {
    LinearSpring::for_each_motion(at(p, impact.radius), impact, spin_gain, add);
  }
  static double largest_force(const Pair& p, double share, double overlap, const Impact& impact) {
    return LinearSpring::largest_force(at(p, impact.radius), share, overlap, impact);
  }

  // ---- what kernels read: one row of numbers a pair of materials

  enum Field { Kn, Kt, InverseKt, Mu, Cap, Cn, TangentialRatio, kNumFields };
  static void write(const Pair& p, const ContactRules& rules, double* row);
  enum Level { Only, kNumLevels };
  static Level level(const Pair& /*p*/) { return Only; }
  static constexpr int fields_read(int /*level*/) { return kNumFields; }

  template <class S>
  struct Constants {
    using Real = typename S::Real;
    Real kn, kt, inverse_kt;  ///< of R = 1 m
    Real mu, cap;
    Real cn;  ///< 2·zeta·sqrt(kn) [sqrt(N)/m]
    Real tangential_ratio;
  };

  // ---- the law

  static double energy(const double* row, const History& history, const Overlap& overlap,
                       const double* spring) {
    return LinearSpring::energy(row, history, overlap, spring) / overlap.inverse_radius;
  }

  /// @param s  the tangential spring [m]
  template <class S, int Level, int Dim, int Length>
  [[gnu::always_inline]] static inline typename S::Mask touch(
      const Constants<S>& c, const PairState<S, Dim>& p, typename S::Real dt,
      typename S::Real (&s)[Length], PairForce<S, Dim>& out, Touch<S, Dim>& t) {
    using Real = typename S::Real;
    const Real both = S::set(1.0) / (p.inverse_mass * p.inverse_radius);  // m_eff·R
    const Real radius = both * p.inverse_mass, none = S::set(0.0);
    const Real cn = c.cn * S::sqrt(both);
    const LinearSpring::Constants<S> scaled{c.kn * radius,
                                            c.kt * radius,
                                            c.inverse_kt * p.inverse_radius,
                                            c.mu,
                                            c.cap,
                                            cn,
                                            c.tangential_ratio * cn,
                                            none,
                                            none,
                                            none,
                                            none};
    return LinearSpring::touch<S, LinearSpring::Constant>(scaled, p, dt, s, out, t);
  }
  template <class S, int Level, int Dim, int Length>
  [[gnu::always_inline]] static inline typename S::Mask respond(const Constants<S>& c,
                                                                const PairState<S, Dim>& p,
                                                                typename S::Real dt,
                                                                typename S::Real (&s)[Length],
                                                                PairForce<S, Dim>& out) {
    Touch<S, Dim> t;
    return touch<S, Level>(c, p, dt, s, out, t);
  }
};

}  // namespace barchan
