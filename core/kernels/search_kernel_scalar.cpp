#include <barchan/core/kernels/search_loop.hpp>
#include <barchan/core/simd/scalar.hpp>

namespace barchan::kernels {

SearchKernel pick_search_scalar(int dim) {
  return pick_search<simd::Scalar>(dim);
}

}  // namespace barchan::kernels
