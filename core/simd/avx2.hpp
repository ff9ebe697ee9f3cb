#pragma once

#include <immintrin.h>

#define BARCHAN_INLINE [[gnu::always_inline]] static inline

namespace barchan::simd {

/// Four pairs at a time. Included only where the compiler is told of AVX2.
struct Avx2 {
  using Real = double __attribute__((vector_size(32)));
  using Mask = __m256d;
  static constexpr int kWidth = 4;

  BARCHAN_INLINE Real set(double a) { return Real(_mm256_set1_pd(a)); }
  BARCHAN_INLINE Real sqrt(Real a) { return Real(_mm256_sqrt_pd(__m256d(a))); }
  BARCHAN_INLINE Real max(Real a, Real b) { return Real(_mm256_max_pd(__m256d(a), __m256d(b))); }
  BARCHAN_INLINE Real abs(Real a) {
    return Real(_mm256_andnot_pd(_mm256_set1_pd(-0.0), __m256d(a)));
  }
  BARCHAN_INLINE Real copysign(Real magnitude, Real sign) {
    return Real(
        _mm256_or_pd(__m256d(magnitude), _mm256_and_pd(_mm256_set1_pd(-0.0), __m256d(sign))));
  }
  BARCHAN_INLINE Real round(Real a) { return Real(_mm256_round_pd(__m256d(a), 8)); }
  BARCHAN_INLINE Mask less(Real a, Real b) {
    return _mm256_cmp_pd(__m256d(a), __m256d(b), _CMP_LT_OQ);
  }
  BARCHAN_INLINE Real select(Mask m, Real a, Real b) {
    return Real(_mm256_blendv_pd(__m256d(b), __m256d(a), m));
  }
  BARCHAN_INLINE Real where(Mask m, Real a) { return Real(_mm256_and_pd(m, __m256d(a))); }
  BARCHAN_INLINE Real odd(Real a) {
    return Real(_mm256_or_pd(__m256d(a), _mm256_castsi256_pd(_mm256_set1_epi64x(1))));
  }
  BARCHAN_INLINE Real rough_cube_root(Real a) {
    const __m256i high = _mm256_srli_epi64(_mm256_castpd_si256(__m256d(a)), 32);
    const __m256i third =
        _mm256_srli_epi64(_mm256_mul_epu32(high, _mm256_set1_epi64x(0x55555556)), 32);
    return Real(_mm256_castsi256_pd(
        _mm256_slli_epi64(_mm256_add_epi64(third, _mm256_set1_epi64x(715094163)), 32)));
  }
  BARCHAN_INLINE bool any(Mask m) { return _mm256_movemask_pd(m) != 0; }
  BARCHAN_INLINE unsigned bits(Mask m) { return static_cast<unsigned>(_mm256_movemask_pd(m)); }
  BARCHAN_INLINE int write_set(unsigned bits, int first, int* to) {
    int count = 0;
    for (int q = 0; q < kWidth; ++q) {
      to[count] = first + q;
      count += static_cast<int>(bits >> q & 1U);
    }
    return count;
  }

  BARCHAN_INLINE Real load_unaligned(const double* p) { return Real(_mm256_loadu_pd(p)); }
  BARCHAN_INLINE Real load(const double* p) { return Real(_mm256_load_pd(p)); }
  BARCHAN_INLINE void store(double* p, Real a) { _mm256_store_pd(p, __m256d(a)); }

  /// Rows a, b, c, d become columns.
  BARCHAN_INLINE void transpose(Real& a, Real& b, Real& c, Real& d) {
    const __m256d l0 = _mm256_unpacklo_pd(__m256d(a), __m256d(b)),
                  h0 = _mm256_unpackhi_pd(__m256d(a), __m256d(b));
    const __m256d l1 = _mm256_unpacklo_pd(__m256d(c), __m256d(d)),
                  h1 = _mm256_unpackhi_pd(__m256d(c), __m256d(d));
    a = Real(_mm256_permute2f128_pd(l0, l1, 0x20));
    b = Real(_mm256_permute2f128_pd(h0, h1, 0x20));
    c = Real(_mm256_permute2f128_pd(l0, l1, 0x31));
    d = Real(_mm256_permute2f128_pd(h0, h1, 0x31));
  }
};

}  // namespace barchan::simd
