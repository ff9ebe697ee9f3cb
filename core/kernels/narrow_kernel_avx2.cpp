#include <barchan/core/kernels/batch_avx2.hpp>
#include <barchan/core/kernels/narrow_loop.hpp>

namespace barchan::kernels {

NarrowKernel pick_narrow_avx2(int dim, bool periodic) {
  return pick_narrow<BatchAvx2>(dim, periodic);
}

}  // namespace barchan::kernels
