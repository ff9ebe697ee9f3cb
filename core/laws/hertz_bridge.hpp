#pragma once

#include <array>
#include <optional>
#include <string>

#include <barchan/core/laws/hertz_mindlin.hpp>
#include <barchan/core/laws/mindlin.hpp>

namespace barchan {

/// Hertz–Mindlin contacts of wet spheres: a bridge of liquid forms where two touch, and pulls until
/// they are so far apart that it ruptures. What is not said here is as there.
///
///   s = max(0, −overlap),  r = 2·R,  x = s·sqrt(r/V)
///   F = 2·pi·r·sigma·cos(theta)/(1 + 1.05·x + 2.5·x²)       while s < (1 + theta/2)·V^(1/3)
///
/// r is the radius of two equal spheres; a sphere at a wall pulls like two of twice its size
/// (Derjaguin). V is the volume of every bridge, which the liquid of no particle runs short of.
/// The clamp holds spring and dashpot, not F, and friction goes by them alone.
/// Sources: Willett, Adams, Johnson & Seville 2000, doi:10.1021/la000657y (force); Lian, Thornton &
/// Adams 1993, doi:10.1006/jcis.1993.1452 (rupture).
struct HertzBridge : HertzMindlin, RespondsByTouch<HertzBridge> {
  static constexpr bool sticks_by(Adhesion adhesion) { return adhesion == Adhesion::Bridge; }

  // ---- what a deck says of a pair of materials (hertz_bridge.cpp), in its [[bridge]]

  template <class P, class Visit>
  static void for_each_number(P& p, Visit&& visit) {
    HertzMindlin::for_each_number(p, visit);
    visit("surface_tension", p.bridge.surface_tension);
    visit("contact_angle", p.bridge.contact_angle);
    visit("volume", p.bridge.volume);
  }

  // ---- what `check` prints of it
  static constexpr const char* kColumns[] = {"E* [Pa]",  "G* [Pa]",      "alpha",
                                             "friction", "bridge [N/m]", "ruptures at [m]"};
  static std::array<std::string, 6> texts(const Pair& p);

  // ---- how strong a contact may be, and how far it holds
  static double largest_force(const Pair& p, double share, double overlap, const Impact& impact);
  /// Where bridges rupture [m]; 0: there are none.
  static double rupture(const Pair& p);
  static double range(const Pair& p, const ContactRules& /*rules*/, double /*radius*/) {
    return rupture(p);
  }

  // ---- what kernels read: the row of Hertz–Mindlin, and the bridge

  enum Field {
    Pull = HertzMindlin::kNumFields,  ///< 4·pi·sigma·cos(theta) [N/m]
    Scale,                            ///< 2/V [1/m³]
    Rupture,                          ///< [m]; 0: no bridge
    kNumFields
  };
  static void write(const Pair& p, const ContactRules& rules, double* row);
  static constexpr int fields_read(int /*level*/) { return kNumFields; }

  template <class S>
  struct Constants {
    using Real = typename S::Real;
    typename HertzMindlin::Constants<S> hertz;
    Real pull, scale, rupture;
  };

  // ---- the law

  using RespondsByTouch<HertzBridge>::respond;

  /// The history of HertzMindlin; the radius of a contact whose bridge alone holds is −1.
  static double energy(const double* row, const History& history, const Overlap& overlap,
                       const double* numbers);

  template <class S, int Level>
  [[gnu::always_inline]] static inline typename S::Mask touch(
      const Constants<S>& c, const PairState<S, 3>& p, typename S::Real dt,
      typename S::Real (&s)[4], PairForce<S, 3>& out, Touch<S, 3>& t) {
    using Real = typename S::Real;
    const Real zero = S::set(0.0), one = S::set(1.0);
    const Real held = p.reach + S::select(S::less(zero, S::abs(s[3])), c.rupture, zero);
    const Real d2 = p.dx * p.dx + p.dy * p.dy + p.dz * p.dz;
    const auto holds = S::less(d2, held * held);
    if (!S::any(holds)) {
      s[0] = s[1] = s[2] = s[3] = zero;
      return holds;
    }
    const auto touching = S::less(d2, p.reach * p.reach);
    const Real d = S::sqrt(d2);
    const Real overlap = S::select(touching, p.reach - d, zero);
    const Real gap = S::select(touching, zero, d - p.reach);
    const Pairing<S> pair(p, d);
    const Real a = S::sqrt(pair.radius * overlap);
    const Real damping = c.hertz.damping * S::sqrt(pair.mass * a);
    const Real normal = damping * pair.vn - c.hertz.kn * a * overlap;
    const Real pressing = S::select(S::less(c.hertz.cap, normal), c.hertz.cap, normal);
    const Real pressed = S::abs(pressing);
    const Real x2 = c.scale * pair.radius * (gap * gap);
    const Real fit = (S::set(1.05) * S::sqrt(x2) + S::set(2.5) * x2) + one;
    const Real adhesive = c.pull * pair.radius / fit;

    const Real limit = c.hertz.mu * pressed, viscous = c.hertz.tangential_ratio * damping;
    Real f[3] = {s[0], s[1], s[2]}, h[3];
    mindlin<S>(c.hertz, pair, a, s[3], viscous, limit, dt, f, h);
    for (int q = 0; q < 3; ++q) s[q] = S::where(touching, f[q]);
    const Real radius = S::select(S::less(zero, c.hertz.kt + c.rupture), a, zero);
    s[3] = S::where(holds, S::select(touching, radius, zero - one));
    pair.act(pressing + adhesive, h, out);
    out.size = (pressed + adhesive) + limit;
    t = {pressed, c.hertz.kt * a, viscous, limit,   pair.radius * overlap,
         pair.nx, pair.ny,        pair.nz, touching};
    return holds;
  }
};

}  // namespace barchan
