#pragma once

#include <barchan/core/kernels/pair_job.hpp>
#include <barchan/core/laws/contact.hpp>
#include <barchan/core/simd/avx2.hpp>

namespace barchan::kernels {

/// Four pairs: aligned loads of half records, differences, 4×4 transposes.
struct BatchAvx2 {
  using Simd = simd::Avx2;
  using Real = Simd::Real;

  template <class Law>
  struct Tables {
    const double* rows;
    typename Law::template Constants<Simd> first;  ///< the only pair of materials there is
  };

  template <class Law, int Level>
  BARCHAN_INLINE typename Law::template Constants<Simd> gather_rows(const double* rows,
                                                                    const std::uint8_t* code) {
    constexpr int kQuads = (Law::fields_read(Level) + 3) / 4;
    Real r[kQuads][4];
    for (int q = 0; q < 4; ++q) {
      for (int h = 0; h < kQuads; ++h) r[h][q] = Simd::load(rows + LawView::kRow * code[q] + 4 * h);
    }
    for (int h = 0; h < kQuads; ++h) Simd::transpose(r[h][0], r[h][1], r[h][2], r[h][3]);
    return constants_from<Law, Simd>(
        [&r](auto field) __attribute__((always_inline)) {
          if constexpr (field.kPlace < 4 * kQuads)
            return r[field.kPlace / 4][field.kPlace % 4];
          else
            return Real{};
        },
        FieldsOf<Law>{});
  }

  template <class Law, int Level, bool OneRow>
  BARCHAN_INLINE Tables<Law> tables(const LawView& laws) {
    Tables<Law> t{laws.rows, {}};
    const std::uint8_t only[4] = {1, 1, 1, 1};
    if constexpr (OneRow) t.first = gather_rows<Law, Level>(laws.rows, only);
    return t;
  }

  template <class Law, int Level, bool OneRow>
  BARCHAN_INLINE Looked<Law, Simd, OneRow> constants(const Tables<Law>& t,
                                                     const std::uint8_t* code) {
    if constexpr (OneRow)
      return t.first;
    else
      return gather_rows<Law, Level>(t.rows, code);
  }

  template <class T>
  BARCHAN_INLINE T* at(T* base, int stride, std::int32_t i) {
    return base + stride * static_cast<std::size_t>(static_cast<std::uint32_t>(i));
  }

  /// Half records a·sign + b; sign is ±1, so the fused operation gives what a difference does.
  BARCHAN_INLINE Real combine(Real a, Real sign, Real b) {
    return Real(_mm256_fmadd_pd(__m256d(a), __m256d(sign), __m256d(b)));
  }

  BARCHAN_INLINE void gather(const PairJob& job, std::int64_t k, PairState<Simd, 2>& p) {
    const Real sign_x = {-1, -1, 1, 1}, sign_v = {-1, -1, 1, 1};
    Real x[4], v[4];
    for (int q = 0; q < 4; ++q) {
      const double *a = at(job.motion, 8, job.i[k + q]), *b = at(job.motion, 8, job.j[k + q]);
      x[q] = combine(Simd::load(a), sign_x, Simd::load(b));
      v[q] = combine(Simd::load(a + 4), sign_v, Simd::load(b + 4));
    }
    Simd::transpose(x[0], x[1], x[2], x[3]);
    Simd::transpose(v[0], v[1], v[2], v[3]);
    p = {x[0], x[1], x[2], v[0], v[1], v[2], v[3], x[3]};
  }

  BARCHAN_INLINE void gather(const PairJob& job, std::int64_t k, PairState<Simd, 3>& p) {
    const Real sign = {-1, -1, -1, 1};
    Real x[4], v[4], u[4];
    for (int q = 0; q < 4; ++q) {
      const double *a = at(job.motion, 8, job.i[k + q]), *b = at(job.motion, 8, job.j[k + q]);
      x[q] = combine(Simd::load(a), sign, Simd::load(b));
      v[q] = combine(Simd::load(a + 4), sign, Simd::load(b + 4));
      u[q] = Simd::load(at(job.spin, 4, job.i[k + q])) + Simd::load(at(job.spin, 4, job.j[k + q]));
    }
    Simd::transpose(x[0], x[1], x[2], x[3]);
    Simd::transpose(v[0], v[1], v[2], v[3]);
    Simd::transpose(u[0], u[1], u[2], u[3]);
    p = {x[0], x[1], x[2], x[3], v[0], v[1], v[2], v[3], u[0], u[1], u[2], u[3]};
  }

  /// Number `place` of the records of four particles.
  BARCHAN_INLINE Real pick(const double* records, int stride, const std::int32_t* row, int place) {
    return Real{at(records, stride, row[0])[place], at(records, stride, row[1])[place],
                at(records, stride, row[2])[place], at(records, stride, row[3])[place]};
  }

  BARCHAN_INLINE void gather(const PairJob& job, std::int64_t k, TurningPair<Simd, 2>& p) {
    gather(job, k, static_cast<PairState<Simd, 2>&>(p));
    p.inverse_first = pick(job.motion, 8, job.i + k, 3);
    p.inverse_second = pick(job.motion, 8, job.j + k, 3);
    p.turn = pick(job.motion, 8, job.j + k, 6) * p.inverse_second -
             pick(job.motion, 8, job.i + k, 6) * p.inverse_first;
  }

  BARCHAN_INLINE void gather(const PairJob& job, std::int64_t k, TurningPair<Simd, 3>& p) {
    gather(job, k, static_cast<PairState<Simd, 3>&>(p));
    Real u[4], w[4];
    for (int q = 0; q < 4; ++q) {
      u[q] = Simd::load(at(job.spin, 4, job.i[k + q]));
      w[q] = Simd::load(at(job.spin, 4, job.j[k + q]));
    }
    Simd::transpose(u[0], u[1], u[2], u[3]);
    Simd::transpose(w[0], w[1], w[2], w[3]);
    p.inverse_first = u[3], p.inverse_second = w[3];
    p.turn_x = w[0] * w[3] - u[0] * u[3];
    p.turn_y = w[1] * w[3] - u[1] * u[3];
    p.turn_z = w[2] * w[3] - u[2] * u[3];
  }

  template <int Dim>
  BARCHAN_INLINE void gather_positions(const PairJob& job, std::int64_t k, Real& dx, Real& dy,
                                       Real& dz, Real& reach) {
    const Real sign = {-1, -1, Dim == 2 ? 1.0 : -1.0, 1};
    Real x[4];
    for (int q = 0; q < 4; ++q) {
      x[q] = combine(Simd::load(at(job.motion, 8, job.i[k + q])), sign,
                     Simd::load(at(job.motion, 8, job.j[k + q])));
    }
    Simd::transpose(x[0], x[1], x[2], x[3]);
    dx = x[0], dy = x[1], dz = x[2], reach = x[Dim];
  }

  template <bool TwoTorques, class Records>
  BARCHAN_INLINE const Records& of_second(const Records& same, const Records& other) {
    return TwoTorques ? other : same;
  }

  /// Force records [fx fy ft size] of four pairs, pair q in r[q].
  BARCHAN_INLINE void records(const PairForce<Simd, 2>& f, Real (&r)[4]) {
    r[0] = f.fx, r[1] = f.fy, r[2] = f.ft, r[3] = f.size;
    Simd::transpose(r[0], r[1], r[2], r[3]);
  }

  /// Force records [fx fy fz size | tx ty tz 0] of four pairs.
  BARCHAN_INLINE void records(const PairForce<Simd, 3>& f, Real (&r)[8]) {
    r[0] = f.fx, r[1] = f.fy, r[2] = f.fz, r[3] = f.size;
    r[4] = f.tx, r[5] = f.ty, r[6] = f.tz, r[7] = Simd::set(0.0);
    Simd::transpose(r[0], r[1], r[2], r[3]);
    Simd::transpose(r[4], r[5], r[6], r[7]);
  }

  /// @param f  on the first of the pair. @param g  the same with the torque on the second
  template <bool TwoTorques>
  BARCHAN_INLINE void scatter(const PairJob& job, std::int64_t k, const PairForce<Simd, 2>& f,
                              const PairForce<Simd, 2>& g) {
    const Real sign = {-1, -1, 1, 1};
    Real r[4], other[4];
    records(f, r);
    if constexpr (TwoTorques) records(g, other);
    const auto& second = of_second<TwoTorques>(r, other);
    for (int q = 0; q < 4; ++q) {
      double* a = at(job.force, 4, job.i[k + q]);
      Simd::store(a, Simd::load(a) + r[q]);
      double* b = at(job.force, 4, job.j[k + q]);
      Simd::store(b, combine(second[q], sign, Simd::load(b)));
    }
  }

  template <bool TwoTorques>
  BARCHAN_INLINE void scatter(const PairJob& job, std::int64_t k, const PairForce<Simd, 3>& f,
                              const PairForce<Simd, 3>& g) {
    const Real sign = {-1, -1, -1, 1};
    Real r[8], other[8];
    records(f, r);
    if constexpr (TwoTorques) records(g, other);
    const auto& second = of_second<TwoTorques>(r, other);
    for (int q = 0; q < 4; ++q) {
      double* a = at(job.force, 8, job.i[k + q]);
      Simd::store(a, Simd::load(a) + r[q]);
      Simd::store(a + 4, Simd::load(a + 4) + r[4 + q]);
      double* b = at(job.force, 8, job.j[k + q]);
      Simd::store(b, combine(second[q], sign, Simd::load(b)));
      Simd::store(b + 4, Simd::load(b + 4) + second[4 + q]);
    }
  }
};

}  // namespace barchan::kernels
