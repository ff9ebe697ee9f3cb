#include <barchan/core/kernels/search_loop.hpp>
#include <barchan/core/simd/avx512.hpp>

namespace barchan::kernels {

SearchKernel pick_search_avx512(int dim) {
  return pick_search<simd::Avx512>(dim);
}

}  // namespace barchan::kernels
