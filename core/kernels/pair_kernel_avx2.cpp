#include <barchan/core/kernels/batch_avx2.hpp>
#include <barchan/core/kernels/pair_loop.hpp>

namespace barchan::kernels {

PairKernel pick_avx2(int dim, int flags) {
  return dim == 2 ? pick<BatchAvx2, 2>(flags) : pick<BatchAvx2, 3>(flags);
}

}  // namespace barchan::kernels
