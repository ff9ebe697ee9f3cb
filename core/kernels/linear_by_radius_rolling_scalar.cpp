#include <barchan/core/kernels/batch_scalar.hpp>
#include <barchan/core/kernels/pair_loop.hpp>

namespace barchan::kernels {

template <class Law>
PairKernel pick_scalar(int dim, int variant) {
  return pick_in<Law, BatchScalar>(dim, variant);
}

template PairKernel pick_scalar<WithRolling<LinearByRadius>>(int, int);

}  // namespace barchan::kernels
