#include <barchan/core/kernels/batch_avx2.hpp>
#include <barchan/core/kernels/pair_loop.hpp>

namespace barchan::kernels {

PairKernel pick_avx2(int dim, int variant) {
  return dim == 2 ? pick<BatchAvx2, 2>(variant) : pick<BatchAvx2, 3>(variant);
}

}  // namespace barchan::kernels
