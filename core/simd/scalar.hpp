#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace barchan::simd {

/// One pair at a time. The vector policies have the same members and give the same bits.
struct Scalar {
  using Real = double;
  using Mask = bool;
  static constexpr int kWidth = 1;

  static Real set(double a) { return a; }
  static Real load(const double* p) { return *p; }
  static Real load_unaligned(const double* p) { return *p; }
  static void store(double* p, Real a) { *p = a; }
  static Real sqrt(Real a) { return __builtin_sqrt(a); }
  static Real abs(Real a) { return __builtin_fabs(a); }
  /// `magnitude` >= 0 with the sign of `sign`.
  static Real copysign(Real magnitude, Real sign) { return __builtin_copysign(magnitude, sign); }
  static Real round(Real a) { return __builtin_rint(a); }
  static Mask less(Real a, Real b) { return a < b; }
  static Real select(Mask m, Real a, Real b) { return m ? a : b; }
  /// a where m, else +0.
  static Real where(Mask m, Real a) { return m ? a : 0.0; }
  /// With the last bit set; in a register of numbers, since the way to one of integers is long.
  static Real odd(Real a) {
    using Pair = double __attribute__((vector_size(16)));
    using Bits = long long __attribute__((vector_size(16)));
    return Pair(Bits(Pair{a, 0.0}) | Bits{1, 0})[0];
  }
  /// The cube root of a positive number, to a thirtieth: a third of its exponent.
  static Real rough_cube_root(Real a) {
    const std::uint64_t high = std::bit_cast<std::uint64_t>(a) >> 32;
    return std::bit_cast<Real>(((high * 0x55555556U >> 32) + 715094163U) << 32);
  }
  static bool any(Mask m) { return m; }
  static unsigned bits(Mask m) { return m ? 1U : 0U; }
  /// Writes first + q for every bit q that is set, and returns how many; up to kWidth are written
  /// over.
  static int write_set(unsigned bits, int first, int* to) {
    *to = first;
    return static_cast<int>(bits);
  }
};

}  // namespace barchan::simd
