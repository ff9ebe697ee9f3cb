#include <barchan/core/kernels/search_loop.hpp>
#include <barchan/core/simd/avx512.hpp>

namespace barchan::kernels {

SearchKernel pick_search_avx512(int dim, bool periodic) {
  return pick_search<simd::Avx512>(dim, periodic);
}

}  // namespace barchan::kernels
