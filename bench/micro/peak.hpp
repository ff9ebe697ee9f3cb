#pragma once

#include <cstdint>

namespace barchan::micro {

// Independent chains of one multiplication and one addition each, unfused, as the law must have
// them for the same bits everywhere. Each function makes rounds·kChains·2 operations per lane.

inline constexpr int kChains = 12;

double peak_scalar(std::int64_t rounds);
double peak_avx2(std::int64_t rounds);
double peak_avx512(std::int64_t rounds);

template <class Real>
[[gnu::always_inline]] inline double peak_of(std::int64_t rounds, Real one) {
  Real a[kChains], b[kChains];
  for (int c = 0; c < kChains; ++c) {
    a[c] = one * (1.0 + 0.01 * c);
    b[c] = one * (0.5 + 0.01 * c);
  }
  const Real scale = one * 0.999999, shift = one * 1e-6;
  for (std::int64_t r = 0; r < rounds; ++r) {
#pragma GCC unroll 12
    for (int c = 0; c < kChains; ++c) {
      a[c] = a[c] * scale;
      b[c] = b[c] + shift;
    }
    asm volatile("" ::: "memory");
  }
  Real sum = a[0] + b[0];
  for (int c = 1; c < kChains; ++c) sum = sum + a[c] + b[c];
  if constexpr (sizeof(Real) == sizeof(double))
    return sum;
  else
    return sum[0];
}

}  // namespace barchan::micro
