#include <barchan/core/kernels/batch_avx512.hpp>
#include <barchan/core/kernels/pair_loop.hpp>

namespace barchan::kernels {

template <class Law>
PairKernel pick_avx512(int dim, int variant) {
  return pick_in<Law, BatchAvx512>(dim, variant);
}

template PairKernel pick_avx512<WithRolling<LinearByRadius>>(int, int);

}  // namespace barchan::kernels
