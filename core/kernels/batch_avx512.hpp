#pragma once

#include <barchan/core/kernels/pair_job.hpp>
#include <barchan/core/laws/contact.hpp>
#include <barchan/core/simd/avx512.hpp>

namespace barchan::kernels {

/// Eight pairs: one aligned load a record, differences, an 8×8 transpose, and back.
struct BatchAvx512 {
  using Simd = simd::Avx512;
  using Real = Simd::Real;

  template <class Law, bool OneRow>
  struct Tables {
    typename Law::template Constants<Simd> only;  ///< the only pair of materials there is
  };
  template <class Law>
  struct Tables<Law, false> {
    const double* rows;
    int size;
    Real column[Law::kNumFields];  ///< of each field; lane c is pair of materials c
  };

  template <class Law, int... F>
  BARCHAN_INLINE Tables<Law, false> columns_of(const LawView& laws,
                                               std::integer_sequence<int, F...> /*fields*/) {
    return {laws.rows, laws.size, {Simd::load(laws.columns + LawView::kColumn * F)...}};
  }

  template <class Law, int Level, bool OneRow>
  BARCHAN_INLINE Tables<Law, OneRow> tables(const LawView& laws) {
    if constexpr (OneRow) {
      return {constants_from<Law, Simd>(
          [&laws](auto field) __attribute__((always_inline)) {
            return Simd::set(laws.rows[LawView::kRow + field.kPlace]);
          },
          FieldsOf<Law>{})};
    } else {
      return columns_of<Law>(laws, FieldsOf<Law>{});
    }
  }

  template <class Law, int Level, bool OneRow>
  BARCHAN_INLINE Looked<Law, Simd, OneRow> constants(const Tables<Law, OneRow>& t,
                                                     const std::uint8_t* code) {
    if constexpr (OneRow)
      return t.only;
    else
      return look_up<Law, Level>(t, code);
  }

  template <class Law, int Level>
  BARCHAN_INLINE typename Law::template Constants<Simd> look_up(const Tables<Law, false>& t,
                                                                const std::uint8_t* code) {
    const __m512i lane =
        _mm512_cvtepu8_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(code)));
    if (t.size <= LawView::kColumn) {
      return constants_from<Law, Simd>(
          [ lane, &t ](auto field) __attribute__((always_inline)) {
            const Real c = t.column[field.kPlace];
            if constexpr (Law::is_common(field.kPlace))
              return c;
            else if constexpr (field.kPlace < Law::fields_read(Level))
              return Real(_mm512_permutexvar_pd(lane, __m512d(c)));
            else
              return Real{};
          },
          FieldsOf<Law>{});
    }
    const __m512i row = _mm512_slli_epi64(lane, 4);
    return constants_from<Law, Simd>(
        [ row, &t ](auto field) __attribute__((always_inline)) {
          if constexpr (field.kPlace < Law::fields_read(Level))
            return Real(_mm512_i64gather_pd(row, t.rows + field.kPlace, 8));
          else
            return Real{};
        },
        FieldsOf<Law>{});
  }

  BARCHAN_INLINE std::size_t wide(std::int32_t i) { return static_cast<std::uint32_t>(i); }

  /// The columns of eight rows of eight.
  BARCHAN_INLINE void transpose(const __m512d (&a)[8], Real (&o)[8]) {
    const __m512d l0 = _mm512_unpacklo_pd(a[0], a[1]), l1 = _mm512_unpacklo_pd(a[2], a[3]);
    const __m512d l2 = _mm512_unpacklo_pd(a[4], a[5]), l3 = _mm512_unpacklo_pd(a[6], a[7]);
    const __m512d h0 = _mm512_unpackhi_pd(a[0], a[1]), h1 = _mm512_unpackhi_pd(a[2], a[3]);
    const __m512d h2 = _mm512_unpackhi_pd(a[4], a[5]), h3 = _mm512_unpackhi_pd(a[6], a[7]);
    const __m512d m0 = _mm512_shuffle_f64x2(l0, l1, 0x88), m1 = _mm512_shuffle_f64x2(l2, l3, 0x88);
    const __m512d n0 = _mm512_shuffle_f64x2(l0, l1, 0xdd), n1 = _mm512_shuffle_f64x2(l2, l3, 0xdd);
    const __m512d p0 = _mm512_shuffle_f64x2(h0, h1, 0x88), p1 = _mm512_shuffle_f64x2(h2, h3, 0x88);
    const __m512d q0 = _mm512_shuffle_f64x2(h0, h1, 0xdd), q1 = _mm512_shuffle_f64x2(h2, h3, 0xdd);
    o[0] = Real(_mm512_shuffle_f64x2(m0, m1, 0x88)),
    o[4] = Real(_mm512_shuffle_f64x2(m0, m1, 0xdd));
    o[2] = Real(_mm512_shuffle_f64x2(n0, n1, 0x88)),
    o[6] = Real(_mm512_shuffle_f64x2(n0, n1, 0xdd));
    o[1] = Real(_mm512_shuffle_f64x2(p0, p1, 0x88)),
    o[5] = Real(_mm512_shuffle_f64x2(p0, p1, 0xdd));
    o[3] = Real(_mm512_shuffle_f64x2(q0, q1, 0x88)),
    o[7] = Real(_mm512_shuffle_f64x2(q0, q1, 0xdd));
  }

  /// The columns of eight rows of four.
  BARCHAN_INLINE void transpose_halves(const __m256d (&a)[8], Real (&o)[4]) {
    __m512d w[4];
    for (int q = 0; q < 4; ++q)
      w[q] = _mm512_insertf64x4(_mm512_castpd256_pd512(a[q]), a[q + 4], 1);
    const __m512d l0 = _mm512_unpacklo_pd(w[0], w[1]), l1 = _mm512_unpacklo_pd(w[2], w[3]);
    const __m512d h0 = _mm512_unpackhi_pd(w[0], w[1]), h1 = _mm512_unpackhi_pd(w[2], w[3]);
    const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
    const __m512i high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    o[0] = Real(_mm512_permutex2var_pd(l0, low, l1)),
    o[1] = Real(_mm512_permutex2var_pd(h0, low, h1));
    o[2] = Real(_mm512_permutex2var_pd(l0, high, l1)),
    o[3] = Real(_mm512_permutex2var_pd(h0, high, h1));
  }

  /// Records a·sign + b of eight pairs; sign is ±1, so the fused operation rounds once, like a
  /// difference.
  BARCHAN_INLINE void differences(const PairJob& job, std::int64_t k, __m512d sign,
                                  Real (&column)[8]) {
    __m512d row[8];
    for (int q = 0; q < 8; ++q) {
      row[q] = _mm512_fmadd_pd(_mm512_load_pd(job.motion + 8 * wide(job.i[k + q])), sign,
                               _mm512_load_pd(job.motion + 8 * wide(job.j[k + q])));
    }
    transpose(row, column);
  }

  BARCHAN_INLINE void gather(const PairJob& job, std::int64_t k, PairState<Simd, 2>& p) {
    Real c[8];
    differences(job, k, _mm512_setr_pd(-1, -1, 1, 1, -1, -1, 1, 1), c);
    p = {c[0], c[1], c[2], c[4], c[5], c[6], c[7], c[3]};
  }

  BARCHAN_INLINE void gather(const PairJob& job, std::int64_t k, PairState<Simd, 3>& p) {
    Real c[8];
    differences(job, k, _mm512_setr_pd(-1, -1, -1, 1, -1, -1, -1, 1), c);
    __m256d s[8];
    for (int q = 0; q < 8; ++q) {
      s[q] = _mm256_add_pd(_mm256_load_pd(job.spin + 4 * wide(job.i[k + q])),
                           _mm256_load_pd(job.spin + 4 * wide(job.j[k + q])));
    }
    Real u[4];
    transpose_halves(s, u);
    p = {c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], u[0], u[1], u[2], u[3]};
  }

  /// Number `place` of the records of eight particles.
  BARCHAN_INLINE Real pick(const double* records, int stride, const std::int32_t* row, int place) {
    const __m512i at =
        _mm512_cvtepu32_epi64(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(row)));
    return Real(
        _mm512_i64gather_pd(_mm512_mullo_epi64(at, _mm512_set1_epi64(stride)), records + place, 8));
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
    __m256d s[8], t[8];
    for (int q = 0; q < 8; ++q) {
      s[q] = _mm256_load_pd(job.spin + 4 * wide(job.i[k + q]));
      t[q] = _mm256_load_pd(job.spin + 4 * wide(job.j[k + q]));
    }
    Real u[4], w[4];
    transpose_halves(s, u);
    transpose_halves(t, w);
    p.inverse_first = u[3], p.inverse_second = w[3];
    p.turn_x = w[0] * w[3] - u[0] * u[3];
    p.turn_y = w[1] * w[3] - u[1] * u[3];
    p.turn_z = w[2] * w[3] - u[2] * u[3];
  }

  template <int Dim>
  BARCHAN_INLINE void gather_positions(const PairJob& job, std::int64_t k, Real& dx, Real& dy,
                                       Real& dz, Real& reach) {
    const __m256d sign = _mm256_setr_pd(-1, -1, Dim == 2 ? 1 : -1, 1);
    __m256d x[8];
    for (int q = 0; q < 8; ++q) {
      x[q] = _mm256_fmadd_pd(_mm256_load_pd(job.motion + 8 * wide(job.i[k + q])), sign,
                             _mm256_load_pd(job.motion + 8 * wide(job.j[k + q])));
    }
    Real c[4];
    transpose_halves(x, c);
    dx = c[0], dy = c[1], dz = c[2], reach = c[Dim];
  }

  template <bool TwoTorques, class Records>
  BARCHAN_INLINE const Records& of_second(const Records& same, const Records& other) {
    return TwoTorques ? other : same;
  }

  /// Force records [fx fy ft size] of eight pairs, pair q in r[q].
  BARCHAN_INLINE void records(const PairForce<Simd, 2>& f, __m256d (&r)[8]) {
    const __m512d lo = _mm512_unpacklo_pd(__m512d(f.fx), __m512d(f.fy)),
                  tl = _mm512_unpacklo_pd(__m512d(f.ft), __m512d(f.size));
    const __m512d hi = _mm512_unpackhi_pd(__m512d(f.fx), __m512d(f.fy)),
                  th = _mm512_unpackhi_pd(__m512d(f.ft), __m512d(f.size));
    const __m512i a = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11),
                  b = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
    const __m512d o02 = _mm512_permutex2var_pd(lo, a, tl), o13 = _mm512_permutex2var_pd(hi, a, th);
    const __m512d o46 = _mm512_permutex2var_pd(lo, b, tl), o57 = _mm512_permutex2var_pd(hi, b, th);
    r[0] = _mm512_castpd512_pd256(o02), r[2] = _mm512_extractf64x4_pd(o02, 1);
    r[1] = _mm512_castpd512_pd256(o13), r[3] = _mm512_extractf64x4_pd(o13, 1);
    r[4] = _mm512_castpd512_pd256(o46), r[6] = _mm512_extractf64x4_pd(o46, 1);
    r[5] = _mm512_castpd512_pd256(o57), r[7] = _mm512_extractf64x4_pd(o57, 1);
  }

  /// Force records [fx fy fz size | tx ty tz 0] of eight pairs.
  BARCHAN_INLINE void records(const PairForce<Simd, 3>& f, __m512d (&r)[8]) {
    const Real zero = Simd::set(0.0);
    const __m512d rows[8] = {__m512d(f.fx), __m512d(f.fy), __m512d(f.fz), __m512d(f.size),
                             __m512d(f.tx), __m512d(f.ty), __m512d(f.tz), __m512d(zero)};
    Real o[8];
    transpose(rows, o);
    for (int q = 0; q < 8; ++q) r[q] = __m512d(o[q]);
  }

  /// @param f  on the first of the pair. @param g  the same with the torque on the second
  template <bool TwoTorques>
  BARCHAN_INLINE void scatter(const PairJob& job, std::int64_t k, const PairForce<Simd, 2>& f,
                              const PairForce<Simd, 2>& g) {
    const __m256d sign = _mm256_setr_pd(-1, -1, 1, 1);
    __m256d r[8], other[8];
    records(f, r);
    if constexpr (TwoTorques) records(g, other);
    const auto& second = of_second<TwoTorques>(r, other);
    for (int q = 0; q < 8; ++q) {
      double* a = job.force + 4 * wide(job.i[k + q]);
      double* b = job.force + 4 * wide(job.j[k + q]);
      _mm256_store_pd(a, _mm256_add_pd(_mm256_load_pd(a), r[q]));
      _mm256_store_pd(b, _mm256_fmadd_pd(second[q], sign, _mm256_load_pd(b)));
    }
  }

  template <bool TwoTorques>
  BARCHAN_INLINE void scatter(const PairJob& job, std::int64_t k, const PairForce<Simd, 3>& f,
                              const PairForce<Simd, 3>& g) {
    const __m512d sign = _mm512_setr_pd(-1, -1, -1, 1, 1, 1, 1, 1);
    __m512d r[8], other[8];
    records(f, r);
    if constexpr (TwoTorques) records(g, other);
    const auto& second = of_second<TwoTorques>(r, other);
    for (int q = 0; q < 8; ++q) {
      double* a = job.force + 8 * wide(job.i[k + q]);
      double* b = job.force + 8 * wide(job.j[k + q]);
      _mm512_store_pd(a, _mm512_add_pd(_mm512_load_pd(a), r[q]));
      _mm512_store_pd(b, _mm512_fmadd_pd(second[q], sign, _mm512_load_pd(b)));
    }
  }
};

}  // namespace barchan::kernels
