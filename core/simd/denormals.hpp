#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace barchan::simd {

/// While it lives, this thread takes numbers below the smallest normal one for zero. Contributions
/// to sums have their last bit set (kernels/pair_loop.hpp), which makes such numbers of zeros, and
/// a fused operation on one takes a hundred times as long. No sum that starts from a rounder
/// notices.
class DenormalsAreZero {
 public:
#if defined(__SSE2__)
  DenormalsAreZero() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | kDenormalsAreZero);
  }
  ~DenormalsAreZero() {
    _mm_setcsr(before_);
  }
#else
  DenormalsAreZero() = default;
  ~DenormalsAreZero() {}
#endif
  DenormalsAreZero(const DenormalsAreZero&) = delete;
  DenormalsAreZero& operator=(const DenormalsAreZero&) = delete;

 private:
#if defined(__SSE2__)
  static constexpr unsigned kDenormalsAreZero = 0x40;
  unsigned before_;
#endif
};

}  // namespace barchan::simd
