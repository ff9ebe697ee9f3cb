#pragma once

namespace barchan::micro {

/// Floating-point operations of one touching pair that slides, counted by running the law itself.
double law_flops(int dim);

}  // namespace barchan::micro
