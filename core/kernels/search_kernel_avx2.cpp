#include <barchan/core/kernels/search_loop.hpp>
#include <barchan/core/simd/avx2.hpp>

namespace barchan::kernels {

SearchKernel pick_search_avx2(int dim) {
  return pick_search<simd::Avx2>(dim);
}

}  // namespace barchan::kernels
