#include <barchan/core/kernels/batch_scalar.hpp>
#include <barchan/core/kernels/narrow_loop.hpp>
#include <barchan/core/kernels/pair_loop.hpp>

namespace barchan::kernels {

PairKernel pick_scalar(int law, int dim, int variant) {
  return pick_listed<BatchScalar>(Laws{}, law, dim, variant);
}

NarrowKernel pick_narrow_scalar(int dim, bool periodic) {
  return pick_narrow<BatchScalar>(dim, periodic);
}

}  // namespace barchan::kernels
