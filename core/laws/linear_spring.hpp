#pragma once

#include <array>
#include <optional>
#include <string>

#include <barchan/core/laws/contact.hpp>
#include <barchan/core/laws/contact_constants.hpp>
#include <barchan/core/laws/history.hpp>
#include <barchan/core/laws/law_key.hpp>
#include <barchan/core/laws/losses.hpp>

namespace barchan {

/// Linear spring–dashpot with Coulomb friction, written once for one, four or eight pairs
/// (S: simd/*.hpp).
///
///   fn = min(cap, cn·vn − kn·overlap)         cap = 0: the contact never pulls; +inf: it may
///   s' = s + vt·dt                            tangential spring, zero at first touch
///   ft = kt·s' + ct·vt,  |ft| <= mu·|fn|      where friction slides, s' is cut back to the limit
///
/// The response is the force on the first particle of the pair; the second one gets its negative,
/// and both get the same torque / radius. Sources: Cundall & Strack 1979,
/// doi:10.1680/geot.1979.29.1.47; the clamp is ours.
struct LinearSpring : RespondsByTouch<LinearSpring> {
  static constexpr const char* kName = "linear";
  static constexpr bool kIsForDisks = true, kRolls = false;
  static constexpr bool kIsByRadius = false;  ///< springs follow from a modulus and the radii
  static constexpr const char* kChoice = "model = \"linear\"";  ///< in [contact]
  static constexpr bool sticks_by(Adhesion adhesion) { return adhesion == Adhesion::None; }

  // ---- what a deck says of a pair of materials (linear_spring.cpp)

  using Pair = ContactConstants;
  static constexpr int kNumKeys = 8;
  /// Keys of [[material]] and [[pair]].
  static const std::array<LawKey, kNumKeys> kKeys;
  static const auto& keys() { return kKeys; }
  /// A [[pair]] says all of its two materials.
  static constexpr bool kPairsStandAlone = true;
  /// What a material still has to say; none: nothing.
  static std::optional<KeyGap> find_gap(const Pair& material);
  /// What a pair that meets lacks, a key; null: nothing.
  static const char* lacking(const Pair& /*p*/) { return nullptr; }

  /// Calls visit(key, number) for the numbers that act, under the key that gives them.
  template <class P, class Visit>
  static void for_each_number(P& p, Visit&& visit) {
    visit("normal_stiffness", p.kn);
    visit("tangential_stiffness", p.kt);
    visit("friction", p.mu);
    for (auto* part : {&p.cn.constant, &p.cn.rate, &p.cn.critical}) visit("normal_damping", *part);
    for (auto* part : {&p.ct.constant, &p.ct.rate, &p.ct.critical})
      visit("tangential_damping", *part);
  }
  /// Springs and dashpots in series. None when both damp, but in ways that do not add up.
  static std::optional<Pair> mix(const Pair& a, const Pair& b);
  /// Turns a restitution into the dashpot that rebounds with it.
  static void solve(Pair& p, const ContactRules& rules);

  // ---- what `check` prints of it
  static constexpr const char* kColumns[] = {"kn [N/m]", "kt [N/m]", "cn [N·s/m]", "ct [N·s/m]",
                                             "friction"};
  static std::array<std::string, 5> texts(const Pair& p);
  /// Of a free head-on collision.
  static double restitution(const Pair& p, double reduced_mass, const ContactRules& rules);
  /// How to make contacts stiffer. @param factor  by how much
  static std::string stiffer(double stiffness, double factor);

  // ---- the stable step, and how strong a contact may be
  static constexpr bool kStiffens = false;                                    ///< with overlap
  static bool acts(const Pair& p) { return p.kn > 0.0; }                      ///< or cannot meet
  static double pressed_overlap(const Pair& p, double radius, double force);  ///< at rest [m]
  static double struck_overlap(const Pair& p, const Impact& impact);  ///< without dashpot [m]
  static double duration(const Pair& p, const Impact& impact);        ///< without dashpot [s]
  /// Along the normal, where the overlap of the impact is largest [N/m].
  static double stiffness(const Pair& p, const Impact& /*impact*/) { return p.kn; }
  static double dashpot(const Pair& p, const Impact& impact);  ///< there [N·s/m]
  static double tangential_stiffness(const Pair& p, const Impact& /*impact*/) { return p.kt; }
  /// Squared radius of a contact, where one is asked for [m²].
  static double area(const double* /*row*/, const Overlap& overlap) {
    return overlap.depth / overlap.inverse_radius;
  }
  static double tangential_stiffness(const double* row, const Overlap& /*overlap*/) {
    return row[Kt];
  }
  static constexpr bool kKeepsForce = false;  ///< in its history: the stretch of the spring
  /// Springs are as stiff as now, and the history does not tell another area.
  static KeptContact kept_contact(const double* /*row*/, const double* /*numbers*/,
                                  const KeptContact& now) {
    return now;
  }
  /// Calls add(name, mass, stiffness, dashpot) for the motions of a pair [kg, N/m, N·s/m].
  /// @param spin_gain  m r² / I
  template <class Add>
  static void for_each_motion(const Pair& p, const Impact& impact, double spin_gain, Add&& add) {
    const double m = impact.mass;
    add("contact", m, p.kn, 0.0);
    const double cn = dashpot(p, impact);
    if (cn > 0.0) add("damping", m, p.kn, cn);
    add("tangential", m / (1.0 + spin_gain), p.kt, coefficient(p.ct, m));
  }
  /// Known of elastic moduli alone.
  static double wave_time(const Pair& /*p*/, double /*radius*/, double /*density*/) { return 0.0; }
  /// A bound of what a particle bears of `share` contacts at an overlap, or of one impact [N].
  static double largest_force(const Pair& p, double share, double overlap, const Impact& impact);

  // ---- what kernels read: one row of numbers a pair of materials

  enum Field {
    Kn,
    Kt,
    InverseKt,
    Mu,
    Cap,
    Cn,
    Ct,
    CnRate,
    CtRate,
    CnCritical,
    CtCritical,
    kNumFields
  };
  static void write(const Pair& p, const ContactRules& rules, double* row);

  /// What the dashpots of a run depend on; the cheapest that serves all its pairs. A pair gives the
  /// same bits at any level.
  enum Level { Constant, Rate, Critical, kNumLevels };
  static Level level(const Pair& p);
  /// Fields that a level reads, from the first one on.
  static constexpr int fields_read(int level) { return level == Constant ? CnRate : kNumFields; }
  /// Whether a field is the same in every row: kernels take it without a look-up.
  static constexpr bool is_common(int field) { return field == Cap; }

  /// A row, or a batch of them. In the order of Field.
  template <class S>
  struct Constants {
    using Real = typename S::Real;
    Real kn, kt, inverse_kt, mu, cap;
    Real cn, ct;                                      ///< constant parts [N·s/m]
    Real cn_rate, ct_rate, cn_critical, ct_critical;  ///< read only where damping depends on mass
  };

  // ---- the law

  /// 2D: the spring along the tangent, which turns with the pair. 3D: a vector.
  template <int Dim>
  static constexpr History kHistory = Dim == 2 ? History{1, 0b0} : History{3, 0b111};
  template <class S, int Dim>
  using Force = PairForce<S, Dim>;
  template <class S, int Dim>
  using State = PairState<S, Dim>;

  /// Stored in the springs of a contact [J].
  static double energy(const double* row, const History& history, const Overlap& overlap,
                       const double* spring) {
    double s2 = 0.0;
    for (int c = 0; c < history.length; ++c) s2 += spring[c] * spring[c];
    return 0.5 * (row[Kn] * overlap.depth * overlap.depth + row[Kt] * s2);
  }

  /// @param s  the tangential spring [m]
  template <class S, int Level>
  [[gnu::always_inline]] static inline typename S::Mask touch(
      const Constants<S>& c, const PairState<S, 2>& p, typename S::Real dt,
      typename S::Real (&s)[1], PairForce<S, 2>& out, Touch<S, 2>& t) {
    using Real = typename S::Real;
    const Real zero = S::set(0.0);
    const Real d2 = p.dx * p.dx + p.dy * p.dy;
    const auto touching = S::less(d2, p.reach * p.reach);
    if (!S::any(touching)) {
      s[0] = zero;
      return touching;
    }
    const Real d = S::sqrt(d2);
    Real reduced_mass = zero;
    const Real inverse = inverse_of<S, Level != Constant>(d, p.inverse_mass, reduced_mass);
    const Real nx = p.dx * inverse, ny = p.dy * inverse;
    const Real vn = p.vx * nx + p.vy * ny;
    const Real vt = (p.vy * nx - p.vx * ny) - p.surface;
    const auto damp = dashpots<S, Level>(c, reduced_mass);

    const Real normal = damp.cn * vn - c.kn * (p.reach - d);
    const Real fn = S::select(S::less(c.cap, normal), c.cap, normal);
    const Real stretched = s[0] + vt * dt;
    const Real viscous = damp.ct * vt;
    const Real sticking = c.kt * stretched + viscous;
    const Real limit = c.mu * S::abs(fn);
    const auto sliding = S::less(limit, S::abs(sticking));
    const Real ft = S::select(sliding, S::copysign(limit, sticking), sticking);
    const Real kept = S::select(sliding, (ft - viscous) * c.inverse_kt, stretched);

    s[0] = S::where(touching, kept);
    out.fx = fn * nx - ft * ny;
    out.fy = fn * ny + ft * nx;
    out.ft = ft;
    out.size = S::abs(fn) + limit;
    t = {S::abs(fn), c.kt, damp.ct};
    return touching;
  }

  /// @param s  the tangential spring has three components, kept in the tangent plane
  template <class S, int Level>
  [[gnu::always_inline]] static inline typename S::Mask touch(
      const Constants<S>& c, const PairState<S, 3>& p, typename S::Real dt,
      typename S::Real (&s)[3], PairForce<S, 3>& out, Touch<S, 3>& t) {
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
    const Real inverse = inverse_of<S, Level != Constant>(d, p.inverse_mass, reduced_mass);
    const Real nx = p.dx * inverse, ny = p.dy * inverse, nz = p.dz * inverse;
    const Real vn = p.vx * nx + p.vy * ny + p.vz * nz;
    const auto damp = dashpots<S, Level>(c, reduced_mass);
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
    t = {S::abs(fn), c.kt, damp.ct, limit, (p.reach - d) / p.inverse_radius, nx, ny, nz, touching};
    return touching;
  }

 private:
  static double coefficient(const Dashpot& dashpot, double reduced_mass);

  template <class S>
  struct Dashpots {
    typename S::Real cn, ct;
  };
  /// The two dashpots at a given reduced mass.
  template <class S, int Level>
  [[gnu::always_inline]] static inline Dashpots<S> dashpots(const Constants<S>& c,
                                                            typename S::Real reduced_mass) {
    if constexpr (Level == Constant) {
      return {c.cn, c.ct};
    } else {
      Dashpots<S> d{c.cn + c.cn_rate * reduced_mass, c.ct + c.ct_rate * reduced_mass};
      if constexpr (Level == Critical) {
        const auto root = S::sqrt(reduced_mass);
        d.cn += c.cn_critical * root;
        d.ct += c.ct_critical * root;
      }
      return d;
    }
  }
};

}  // namespace barchan
