#include <barchan/core/kernels/batch_avx512.hpp>
#include <barchan/core/kernels/pair_loop.hpp>

namespace barchan::kernels {

PairKernel pick_avx512(int law, int dim, int variant) {
  return pick_listed<BatchAvx512>(Laws{}, law, dim, variant);
}

}  // namespace barchan::kernels
