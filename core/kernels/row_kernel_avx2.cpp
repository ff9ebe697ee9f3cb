#include <barchan/core/kernels/row_loop.hpp>
#include <barchan/core/simd/avx2.hpp>

namespace barchan::kernels {
namespace {

struct Quad : simd::Avx2 {
  BARCHAN_INLINE Real of(double a, double b, double c, double d) { return Real{a, b, c, d}; }
  BARCHAN_INLINE Real last(Real v) { return Real(_mm256_permute4x64_pd(__m256d(v), 0xff)); }
  BARCHAN_INLINE Real where_positive(Real m, Real a) {
    return Real(
        _mm256_and_pd(_mm256_cmp_pd(__m256d(m), _mm256_setzero_pd(), _CMP_GT_OQ), __m256d(a)));
  }
  /// All bits where |a| is more than the limit or no number.
  BARCHAN_INLINE Real beyond(Real a, Real limit) {
    return Real(_mm256_cmp_pd(__m256d(abs(a)), __m256d(limit), _CMP_NLE_UQ));
  }
  BARCHAN_INLINE Real either(Real a, Real b) { return Real(_mm256_or_pd(__m256d(a), __m256d(b))); }
  BARCHAN_INLINE bool has_any(Real a) { return _mm256_movemask_pd(__m256d(a)) != 0; }
};

}  // namespace

RowKernel pick_rows_avx2(int dim, bool damped) {
  return pick_rows<Quad>(dim, damped);
}

}  // namespace barchan::kernels
