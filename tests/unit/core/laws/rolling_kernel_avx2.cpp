#include <barchan/core/kernels/batch_avx2.hpp>

#include "rolling_law.hpp"

namespace barchan::test {

PairKernel pick_rolling_avx2(int dim, int variant) {
  return kernels::pick_in<RollingSpring, kernels::BatchAvx2>(dim, variant);
}

}  // namespace barchan::test
