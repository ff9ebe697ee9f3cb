#include <barchan/core/kernels/batch_scalar.hpp>
#include <barchan/core/kernels/narrow_loop.hpp>
#include <barchan/core/kernels/pair_loop.hpp>

namespace barchan::kernels {

PairKernel pick_scalar(int dim, int variant) {
  return dim == 2 ? pick<BatchScalar, 2>(variant) : pick<BatchScalar, 3>(variant);
}

NarrowKernel pick_narrow_scalar(int dim, bool periodic) {
  return pick_narrow<BatchScalar>(dim, periodic);
}

}  // namespace barchan::kernels
