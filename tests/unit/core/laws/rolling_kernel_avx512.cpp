#include <barchan/core/kernels/batch_avx512.hpp>

#include "rolling_law.hpp"

namespace barchan::test {

PairKernel pick_rolling_avx512(int dim, int variant) {
  return kernels::pick_in<RollingSpring, kernels::BatchAvx512>(dim, variant);
}

}  // namespace barchan::test
