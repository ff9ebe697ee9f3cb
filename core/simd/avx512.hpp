#pragma once

#include <immintrin.h>

#include <barchan/core/simd/avx2.hpp>

namespace barchan::simd {

/// Eight pairs at a time. Included only where the compiler is told of AVX-512.
struct Avx512 {
  using Real = double __attribute__((vector_size(64)));
  struct Mask {
    __mmask8 bits;
  };
  static constexpr int kWidth = 8;

  BARCHAN_INLINE Real set(double a) { return Real(_mm512_set1_pd(a)); }
  BARCHAN_INLINE Real sqrt(Real a) { return Real(_mm512_sqrt_pd(__m512d(a))); }
  BARCHAN_INLINE Real abs(Real a) { return Real(_mm512_abs_pd(__m512d(a))); }
  BARCHAN_INLINE Real copysign(Real magnitude, Real sign) {
    return Real(
        _mm512_or_pd(__m512d(magnitude), _mm512_and_pd(_mm512_set1_pd(-0.0), __m512d(sign))));
  }
  BARCHAN_INLINE Real round(Real a) { return Real(_mm512_roundscale_pd(__m512d(a), 8)); }
  BARCHAN_INLINE Mask less(Real a, Real b) {
    return Mask{_mm512_cmp_pd_mask(__m512d(a), __m512d(b), _CMP_LT_OQ)};
  }
  BARCHAN_INLINE Real select(Mask m, Real a, Real b) {
    return Real(_mm512_mask_blend_pd(m.bits, __m512d(b), __m512d(a)));
  }
  BARCHAN_INLINE Real where(Mask m, Real a) {
    return Real(_mm512_maskz_mov_pd(m.bits, __m512d(a)));
  }
  BARCHAN_INLINE Real odd(Real a) {
    return Real(_mm512_castsi512_pd(
        _mm512_or_epi64(_mm512_castpd_si512(__m512d(a)), _mm512_set1_epi64(1))));
  }
  BARCHAN_INLINE Real rough_cube_root(Real a) {
    const __m512i high = _mm512_srli_epi64(_mm512_castpd_si512(__m512d(a)), 32);
    const __m512i third =
        _mm512_srli_epi64(_mm512_mul_epu32(high, _mm512_set1_epi64(0x55555556)), 32);
    return Real(_mm512_castsi512_pd(
        _mm512_slli_epi64(_mm512_add_epi64(third, _mm512_set1_epi64(715094163)), 32)));
  }
  BARCHAN_INLINE bool any(Mask m) { return m.bits != 0; }
  BARCHAN_INLINE unsigned bits(Mask m) { return m.bits; }
  BARCHAN_INLINE int write_set(unsigned bits, int first, int* to) {
    const __m256i all =
        _mm256_add_epi32(_mm256_set1_epi32(first), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                        _mm256_maskz_compress_epi32(static_cast<__mmask8>(bits), all));
    return __builtin_popcount(bits);
  }

  BARCHAN_INLINE Real load_unaligned(const double* p) { return Real(_mm512_loadu_pd(p)); }
  BARCHAN_INLINE Real load(const double* p) { return Real(_mm512_load_pd(p)); }
  BARCHAN_INLINE void store(double* p, Real a) { _mm512_store_pd(p, __m512d(a)); }
};

}  // namespace barchan::simd
