#pragma once

#include <barchan/core/kernels/pair_loop.hpp>
#include <barchan/core/laws/linear_spring.hpp>

namespace barchan::test {

/// A law that the program does not have, to show that one more is one more file: beside the linear
/// spring a couple, which turns the ends against each other. Its history is longer, and only a part
/// of it changes sign when the ends swap.
struct RollingSpring {
  static constexpr const char* kName = "rolling";
  static constexpr bool kIsForDisks = true;

  enum Field { kRolling = LinearSpring::kNumFields, kNumFields };
  enum Level { kNumLevels = LinearSpring::kNumLevels };
  static constexpr int fields_read(int /*level*/) { return kNumFields; }
  static constexpr bool is_common(int field) { return LinearSpring::is_common(field); }

  template <class S>
  struct Constants {
    using Real = typename S::Real;
    Real kn, kt, inverse_kt, mu, cap, cn, ct, cn_rate, ct_rate, cn_critical, ct_critical;
    Real rolling;
    [[gnu::always_inline]] LinearSpring::Constants<S> linear() const {
      return {kn, kt, inverse_kt, mu, cap, cn, ct, cn_rate, ct_rate, cn_critical, ct_critical};
    }
  };

  /// 2D: the linear spring, a number that flips. 3D: the linear spring, three that do not flip.
  template <int Dim>
  static constexpr History kHistory = Dim == 2 ? History{2, 0b10} : History{6, 0b000111};
  template <class S, int Dim>
  using Force = PairForces<S, Dim>;
  template <class S, int Dim>
  using State = PairState<S, Dim>;

  static double energy(const double* row, const History& history, const Overlap& overlap,
                       const double* numbers) {
    double r2 = 0.0;
    const int linear = history.length / 2;
    for (int c = linear; c < history.length; ++c) r2 += numbers[c] * numbers[c];
    return LinearSpring::energy(row, {linear, 0}, overlap, numbers) + 0.5 * row[kRolling] * r2;
  }

  template <class S, int Level>
  [[gnu::always_inline]] static inline typename S::Mask respond(const Constants<S>& c,
                                                                const PairState<S, 2>& p,
                                                                typename S::Real dt,
                                                                typename S::Real (&h)[2],
                                                                PairForces<S, 2>& out) {
    typename S::Real spring[1] = {h[0]};
    const auto touching = LinearSpring::respond<S, Level>(c.linear(), p, dt, spring, out.first);
    h[0] = spring[0];
    h[1] = S::where(touching, h[1] + p.vx * dt);
    if (!S::any(touching)) return touching;
    const auto couple = c.rolling * h[1];
    out.first.size = out.first.size + S::abs(couple);
    out.second = out.first;
    out.first.ft = out.first.ft + couple;
    out.second.ft = out.second.ft - couple;
    return touching;
  }

  template <class S, int Level>
  [[gnu::always_inline]] static inline typename S::Mask respond(const Constants<S>& c,
                                                                const PairState<S, 3>& p,
                                                                typename S::Real dt,
                                                                typename S::Real (&h)[6],
                                                                PairForces<S, 3>& out) {
    typename S::Real spring[3] = {h[0], h[1], h[2]};
    const auto touching = LinearSpring::respond<S, Level>(c.linear(), p, dt, spring, out.first);
    for (int q = 0; q < 3; ++q) h[q] = spring[q];
    h[3] = S::where(touching, h[3] + p.ux * dt);
    h[4] = S::where(touching, h[4] + p.uy * dt);
    h[5] = S::where(touching, h[5] + p.uz * dt);
    if (!S::any(touching)) return touching;
    const auto gain = c.rolling / S::sqrt(p.dx * p.dx + p.dy * p.dy + p.dz * p.dz);
    const auto x = gain * (h[4] * p.dz - h[5] * p.dy), y = gain * (h[5] * p.dx - h[3] * p.dz),
               z = gain * (h[3] * p.dy - h[4] * p.dx);
    out.first.size = out.first.size + ((S::abs(x) + S::abs(y)) + S::abs(z));
    out.second = out.first;
    out.first.tx = out.first.tx + x, out.second.tx = out.second.tx - x;
    out.first.ty = out.first.ty + y, out.second.ty = out.second.ty - y;
    out.first.tz = out.first.tz + z, out.second.tz = out.second.tz - z;
    return touching;
  }
};

PairKernel pick_rolling_avx2(int dim, int variant);
PairKernel pick_rolling_avx512(int dim, int variant);

}  // namespace barchan::test
