#pragma once

#include <array>
#include <iterator>
#include <optional>
#include <string>

#include <barchan/core/laws/hertz_mindlin.hpp>

namespace barchan {

/// Hertz–Mindlin contacts that pull while they touch. What is not said here is as there.
///
///   dmt     F = 4·pi·gamma·R                  beside it friction by 4/3·E*·a·overlap + F
///   sjkr    F = kappa·A                       A: of the lens that two spheres share
///   sjkr2   F = kappa·4·pi·R·overlap          friction by Hertz's part alone
///
/// F acts from touch to touch: it vanishes at once where the two part. The clamp holds spring and
/// dashpot, not F. Sources: Derjaguin, Muller & Toporov 1975, doi:10.1016/0021-9797(75)90018-1,
/// friction as by Marshall 2009, doi:10.1016/j.jcp.2008.10.020; sjkr and sjkr2: LIGGGHTS.
struct HertzAdhesive : HertzMindlin, RespondsByTouch<HertzAdhesive> {
  static constexpr bool sticks_by(Adhesion adhesion) {
    return adhesion == Adhesion::Dmt || adhesion == Adhesion::Sjkr || adhesion == Adhesion::Sjkr2;
  }

  // ---- what a deck says of a pair of materials (hertz_adhesive.cpp)

  static const std::array<LawKey, 2> kMoreKeys;
  static const auto& keys() {
    static const auto all = joined_keys(HertzMindlin::kKeys, kMoreKeys);
    return all;
  }
  template <class P, class Visit>
  static void for_each_number(P& p, Visit&& visit) {
    HertzMindlin::for_each_number(p, visit);
    visit("surface_energy", p.surface_energy);
    visit("cohesion_density", p.cohesion_density);
  }
  static std::optional<Pair> mix(const Pair& a, const Pair& b);

  // ---- what `check` prints of it
  static constexpr const char* kColumns[] = {"E* [Pa]", "G* [Pa]", "alpha", "friction", "adhesion"};
  static std::array<std::string, 5> texts(const Pair& p);

  static double largest_force(const Pair& p, double share, double overlap, const Impact& impact);

  // ---- what kernels read: the row of Hertz–Mindlin, and what pulls

  enum Field { Pull = HertzMindlin::kNumFields, Lens, Area, kNumFields };
  static void write(const Pair& p, const ContactRules& rules, double* row);
  static constexpr int fields_read(int /*level*/) { return kNumFields; }

  template <class S>
  struct Constants : HertzMindlin::Constants<S> {
    typename S::Real pull;  ///< 4·pi·gamma [N/m]
    typename S::Real lens;  ///< pi·kappa, of the area of the lens [N/m²]
    typename S::Real area;  ///< 4·pi·kappa [N/m²]
  };

  // ---- the law

  using RespondsByTouch<HertzAdhesive>::respond;

  static double energy(const double* row, const History& history, const Overlap& overlap,
                       const double* numbers);

  template <class S, int Level>
  [[gnu::always_inline]] static inline typename S::Mask touch(
      const Constants<S>& c, const PairState<S, 3>& p, typename S::Real dt,
      typename S::Real (&s)[4], PairForce<S, 3>& out, Touch<S, 3>& t) {
    return touch_of<HertzAdhesive, S>(c, p, dt, s, out, t);
  }

  /// @param fn  spring and dashpot, to which the pull is added
  /// @param pressed  what friction goes by
  template <class S>
  [[gnu::always_inline]] static inline void adhere(const Constants<S>& c, const Pressed<S>& x,
                                                   typename S::Real& fn,
                                                   typename S::Real& pressed) {
    using Real = typename S::Real;
    const Real dmt = c.pull * x.radius;
    // (radius of the lens)²: of two spheres, and where a sphere dips into a plane
    const Real sum = x.overlap * (x.reach + x.d);
    const Real inner = x.d * x.d - x.reach * x.reach + S::set(4.0) * x.radius * x.reach;
    const Real spheres = S::set(0.25) * sum * inner * x.inverse * x.inverse;
    const Real lens = S::select(S::less(S::set(0.5) * x.reach, x.radius), sum, spheres);
    fn = fn + ((dmt + c.area * (x.radius * x.overlap)) + c.lens * lens);
    pressed = S::select(S::less(S::set(0.0), c.pull), x.elastic + dmt, pressed);
  }
};

}  // namespace barchan
