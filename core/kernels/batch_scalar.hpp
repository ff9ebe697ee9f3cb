#pragma once

#include <barchan/core/contact_law.hpp>
#include <barchan/core/kernels/pair_job.hpp>
#include <barchan/core/simd/scalar.hpp>

namespace barchan::kernels {

/// Pair by pair: gather, law, scatter; a pair that does not touch touches no memory but its spring.
struct BatchScalar {
  using Simd = simd::Scalar;

  template <Damping D, bool OneLaw>
  static const double* tables(const LawView& laws) {
    return laws.rows;
  }

  template <Damping D, bool OneLaw>
  static LawConstants<Simd> constants(const double* rows, const std::uint8_t* code) {
    const double* r = rows + LawView::kRow * *code;
    return {r[LawView::Kn],     r[LawView::Kt],         r[LawView::InverseKt], r[LawView::Mu],
            r[LawView::Cap],    r[LawView::Cn],         r[LawView::Ct],        r[LawView::CnRate],
            r[LawView::CtRate], r[LawView::CnCritical], r[LawView::CtCritical]};
  }

  static void gather(const PairJob& job, std::int64_t k, PairState<Simd, 2>& p) {
    const double* a = job.motion + 8 * static_cast<std::int64_t>(job.i[k]);
    const double* b = job.motion + 8 * static_cast<std::int64_t>(job.j[k]);
    p = {b[0] - a[0], b[1] - a[1], a[2] + b[2], b[4] - a[4], b[5] - a[5], a[6] + b[6], a[7] + b[7]};
  }

  static void gather(const PairJob& job, std::int64_t k, PairState<Simd, 3>& p) {
    const std::int64_t i = job.i[k], j = job.j[k];
    const double *a = job.motion + 8 * i, *b = job.motion + 8 * j;
    const double *u = job.spin + 4 * i, *w = job.spin + 4 * j;
    p = {b[0] - a[0], b[1] - a[1], b[2] - a[2], a[3] + b[3], b[4] - a[4], b[5] - a[5],
         b[6] - a[6], a[7] + b[7], u[0] + w[0], u[1] + w[1], u[2] + w[2]};
  }

  template <int Dim>
  static void gather_positions(const PairJob& job, std::int64_t k, double& dx, double& dy,
                               double& dz, double& reach) {
    const double* a = job.motion + 8 * static_cast<std::int64_t>(job.i[k]);
    const double* b = job.motion + 8 * static_cast<std::int64_t>(job.j[k]);
    dx = b[0] - a[0];
    dy = b[1] - a[1];
    dz = Dim == 3 ? b[2] - a[2] : 0.0;
    reach = a[Dim] + b[Dim];
  }

  template <Damping D, int Dim>
  [[gnu::always_inline]] static Simd::Mask respond_with_spring(const PairJob& job, std::int64_t k,
                                                               const LawConstants<Simd>& c,
                                                               const PairState<Simd, Dim>& p,
                                                               double dt, PairForce<Simd, Dim>& f) {
    if constexpr (Dim == 2) {
      return respond<Simd, D>(c, p, dt, job.spring[k], f);
    } else {
      double* s = job.spring + 24 * (k / 8) + k % 8;
      double t[3] = {s[0], s[8], s[16]};
      const bool touching = respond<Simd, D>(c, p, dt, t, f);
      s[0] = t[0];
      s[8] = t[1];
      s[16] = t[2];
      return touching;
    }
  }

  // Two numbers at a time, which every compiler has: half the loads and stores.
  using Two = double __attribute__((vector_size(16)));
  [[gnu::always_inline]] static void add(double* to, Two value) {
    Two sum;
    __builtin_memcpy(&sum, to, sizeof sum);
    sum += value;
    __builtin_memcpy(to, &sum, sizeof sum);
  }

  static void scatter(const PairJob& job, std::int64_t k, const PairForce<Simd, 2>& f) {
    double* a = job.force + 4 * static_cast<std::int64_t>(job.i[k]);
    double* b = job.force + 4 * static_cast<std::int64_t>(job.j[k]);
    const Two force{f.fx, f.fy}, rest{f.ft, f.size};
    add(a, force);
    add(a + 2, rest);
    add(b, -force);
    add(b + 2, rest);
  }

  static void scatter(const PairJob& job, std::int64_t k, const PairForce<Simd, 3>& f) {
    double* a = job.force + 8 * static_cast<std::int64_t>(job.i[k]);
    double* b = job.force + 8 * static_cast<std::int64_t>(job.j[k]);
    const Two force{f.fx, f.fy}, above{f.fz, f.size}, below{-f.fz, f.size}, torque{f.tx, f.ty},
        rest{f.tz, 0.0};
    add(a, force);
    add(a + 2, above);
    add(a + 4, torque);
    add(a + 6, rest);
    add(b, -force);
    add(b + 2, below);
    add(b + 4, torque);
    add(b + 6, rest);
  }
};

}  // namespace barchan::kernels
