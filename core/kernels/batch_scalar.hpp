#pragma once

#include <barchan/core/kernels/pair_job.hpp>
#include <barchan/core/laws/contact.hpp>
#include <barchan/core/simd/scalar.hpp>

namespace barchan::kernels {

/// Pair by pair: gather, law, scatter; one that does not touch writes to its history alone.
struct BatchScalar {
  using Simd = simd::Scalar;

  template <class Law, int Level, bool OneLaw>
  static const double* tables(const LawView& laws) {
    return laws.rows;
  }

  template <class Law, int Level, bool OneLaw>
  static typename Law::template Constants<Simd> constants(const double* rows,
                                                          const std::uint8_t* code) {
    const double* r = rows + LawView::kRow * *code;
    return constants_from<Law, Simd>([r](auto field) { return r[field.kPlace]; }, FieldsOf<Law>{});
  }

  static void gather(const PairJob& job, std::int64_t k, PairState<Simd, 2>& p) {
    const double* a = job.motion + 8 * static_cast<std::int64_t>(job.i[k]);
    const double* b = job.motion + 8 * static_cast<std::int64_t>(job.j[k]);
    p = {b[0] - a[0], b[1] - a[1], a[2] + b[2], b[4] - a[4],
         b[5] - a[5], a[6] + b[6], a[7] + b[7], a[3] + b[3]};
  }

  static void gather(const PairJob& job, std::int64_t k, PairState<Simd, 3>& p) {
    const std::int64_t i = job.i[k], j = job.j[k];
    const double *a = job.motion + 8 * i, *b = job.motion + 8 * j;
    const double *u = job.spin + 4 * i, *w = job.spin + 4 * j;
    p = {b[0] - a[0], b[1] - a[1], b[2] - a[2], a[3] + b[3], b[4] - a[4], b[5] - a[5],
         b[6] - a[6], a[7] + b[7], u[0] + w[0], u[1] + w[1], u[2] + w[2], u[3] + w[3]};
  }

  static void gather(const PairJob& job, std::int64_t k, TurningPair<Simd, 2>& p) {
    gather(job, k, static_cast<PairState<Simd, 2>&>(p));
    const double* a = job.motion + 8 * static_cast<std::int64_t>(job.i[k]);
    const double* b = job.motion + 8 * static_cast<std::int64_t>(job.j[k]);
    p.inverse_first = a[3], p.inverse_second = b[3];
    p.turn = b[6] * b[3] - a[6] * a[3];
  }

  static void gather(const PairJob& job, std::int64_t k, TurningPair<Simd, 3>& p) {
    gather(job, k, static_cast<PairState<Simd, 3>&>(p));
    const double* u = job.spin + 4 * static_cast<std::int64_t>(job.i[k]);
    const double* w = job.spin + 4 * static_cast<std::int64_t>(job.j[k]);
    p.inverse_first = u[3], p.inverse_second = w[3];
    p.turn_x = w[0] * w[3] - u[0] * u[3];
    p.turn_y = w[1] * w[3] - u[1] * u[3];
    p.turn_z = w[2] * w[3] - u[2] * u[3];
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

  // Two numbers at a time, which every compiler has: half the loads and stores.
  using Two = double __attribute__((vector_size(16)));
  [[gnu::always_inline]] static void add(double* to, Two value) {
    Two sum;
    __builtin_memcpy(&sum, to, sizeof sum);
    sum += value;
    __builtin_memcpy(to, &sum, sizeof sum);
  }

  /// @param f  on the first of the pair. @param g  torque on the second
  template <bool TwoTorques>
  static void scatter(const PairJob& job, std::int64_t k, const PairForce<Simd, 2>& f,
                      const PairForce<Simd, 2>& g) {
    double* a = job.force + 4 * static_cast<std::int64_t>(job.i[k]);
    double* b = job.force + 4 * static_cast<std::int64_t>(job.j[k]);
    const Two force{f.fx, f.fy};
    add(a, force);
    add(a + 2, Two{f.ft, f.size});
    add(b, -force);
    add(b + 2, Two{g.ft, f.size});
  }

  template <bool TwoTorques>
  static void scatter(const PairJob& job, std::int64_t k, const PairForce<Simd, 3>& f,
                      const PairForce<Simd, 3>& g) {
    double* a = job.force + 8 * static_cast<std::int64_t>(job.i[k]);
    double* b = job.force + 8 * static_cast<std::int64_t>(job.j[k]);
    const Two force{f.fx, f.fy}, above{f.fz, f.size}, below{-f.fz, f.size};
    add(a, force);
    add(a + 2, above);
    add(a + 4, Two{f.tx, f.ty});
    add(a + 6, Two{f.tz, 0.0});
    add(b, -force);
    add(b + 2, below);
    add(b + 4, Two{g.tx, g.ty});
    add(b + 6, Two{g.tz, 0.0});
  }
};

}  // namespace barchan::kernels
