#include <barchan/core/kernels/batch_scalar.hpp>
#include <barchan/core/kernels/narrow_loop.hpp>

namespace barchan::kernels {

NarrowKernel pick_narrow_scalar(int dim, bool periodic) {
  return pick_narrow<BatchScalar>(dim, periodic);
}

}  // namespace barchan::kernels
