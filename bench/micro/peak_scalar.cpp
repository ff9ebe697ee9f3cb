#include "peak.hpp"

namespace barchan::micro {

double peak_scalar(std::int64_t rounds) {
  return peak_of<double>(rounds, 1.0);
}

}  // namespace barchan::micro
