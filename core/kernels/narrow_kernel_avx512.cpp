#include <barchan/core/kernels/batch_avx512.hpp>
#include <barchan/core/kernels/narrow_loop.hpp>

namespace barchan::kernels {

NarrowKernel pick_narrow_avx512(int dim, bool periodic) {
  return pick_narrow<BatchAvx512>(dim, periodic);
}

}  // namespace barchan::kernels
