#include <barchan/core/kernels/batch_scalar.hpp>
#include <barchan/core/kernels/pair_loop.hpp>

namespace barchan::kernels {

PairKernel pick_scalar(int dim, int variant) {
  return dim == 2 ? pick<BatchScalar, 2>(variant) : pick<BatchScalar, 3>(variant);
}

}  // namespace barchan::kernels
