#pragma once

#include <cstdint>

namespace barchan::micro {

// Independent chains of one multiplication and one addition each, unfused, as the law must have
// them for the same bits everywhere. Each function makes rounds·kChains·2 operations per lane.

inline constexpr int kChains = 6;

double peak_scalar(std::int64_t rounds);
double peak_avx2(std::int64_t rounds);
double peak_avx512(std::int64_t rounds);

template <class Real>
[[gnu::always_inline]] inline double peak_of(std::int64_t rounds, Real one) {
  Real a = one, b = one * 1.1, c = one * 1.2, d = one * 1.3, e = one * 1.4, f = one * 1.5;
  Real g = one, h = one * 1.1, i = one * 1.2, j = one * 1.3, k = one * 1.4, l = one * 1.5;
  const Real scale = one * 0.999999, shift = one * 1e-6;
  for (std::int64_t r = 0; r < rounds;
       ++r) {  // twelve registers, and two of constants: sixteen are there
    a = a * scale, b = b * scale, c = c * scale, d = d * scale, e = e * scale, f = f * scale;
    g = g + shift, h = h + shift, i = i + shift, j = j + shift, k = k + shift, l = l + shift;
  }
  const Real sum = a + b + c + d + e + f + g + h + i + j + k + l;
  if constexpr (sizeof(Real) == sizeof(double)) {
    return sum;
  } else {
    return sum[0];
  }
}

}  // namespace barchan::micro
