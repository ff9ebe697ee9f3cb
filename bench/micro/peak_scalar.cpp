#include "peak.hpp"

namespace barchan::micro {

double peak_scalar(std::int64_t rounds) {
  return peak_of<double>(rounds, 1.0);
}

void triad_scalar(double* a, const double* b, const double* c, std::int64_t n) {
  triad_of<double>(a, b, c, n);
}

}  // namespace barchan::micro
