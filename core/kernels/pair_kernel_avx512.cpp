#include <barchan/core/kernels/batch_avx512.hpp>
#include <barchan/core/kernels/pair_loop.hpp>

namespace barchan::kernels {

PairKernel pick_avx512(int dim, int variant) {
  return dim == 2 ? pick<BatchAvx512, 2>(variant) : pick<BatchAvx512, 3>(variant);
}

}  // namespace barchan::kernels
