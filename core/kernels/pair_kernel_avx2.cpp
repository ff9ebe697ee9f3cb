#include <barchan/core/kernels/batch_avx2.hpp>
#include <barchan/core/kernels/pair_loop.hpp>

namespace barchan::kernels {

PairKernel pick_avx2(int law, int dim, int variant) {
  return pick_listed<BatchAvx2>(Laws{}, law, dim, variant);
}

}  // namespace barchan::kernels
