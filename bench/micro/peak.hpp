#pragma once

#include <cstdint>

namespace barchan::micro {

// Independent chains of one multiplication and one addition each, unfused, as the law must have
// them for the same bits everywhere. Each function makes rounds·kChains·2 operations per lane.

inline constexpr int kChains = 6;

/// a = b + 3·c. @pre n is a multiple of 8, arrays are on cache lines
using Triad = void (*)(double* a, const double* b, const double* c, std::int64_t n);
void triad_scalar(double* a, const double* b, const double* c, std::int64_t n);
void triad_avx2(double* a, const double* b, const double* c, std::int64_t n);
void triad_avx512(double* a, const double* b, const double* c, std::int64_t n);

double peak_scalar(std::int64_t rounds);
double peak_avx2(std::int64_t rounds);
double peak_avx512(std::int64_t rounds);

template <class Real>
[[gnu::always_inline]] inline void triad_of(double* a, const double* b, const double* c,
                                            std::int64_t n) {
  constexpr auto kLanes = static_cast<std::int64_t>(sizeof(Real) / sizeof(double));
  for (std::int64_t i = 0; i < n; i += kLanes) {
    *reinterpret_cast<Real*>(a + i) =
        *reinterpret_cast<const Real*>(b + i) + 3.0 * *reinterpret_cast<const Real*>(c + i);
  }
}

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
