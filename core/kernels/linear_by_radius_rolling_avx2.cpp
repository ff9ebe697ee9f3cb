#include <barchan/core/kernels/batch_avx2.hpp>
#include <barchan/core/kernels/pair_loop.hpp>

namespace barchan::kernels {

template <class Law>
PairKernel pick_avx2(int dim, int variant) {
  return pick_in<Law, BatchAvx2>(dim, variant);
}

template PairKernel pick_avx2<WithRolling<LinearByRadius>>(int, int);

}  // namespace barchan::kernels
