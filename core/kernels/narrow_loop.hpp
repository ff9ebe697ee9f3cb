#pragma once

#include <barchan/core/kernels/pair_loop.hpp>

namespace barchan::kernels {

// Narrow phase alone: which candidates touch or nearly do, a bit each, eight to a byte.

template <class B, int Dim, bool Periodic>
void narrow(const PairJob& given, double margin, std::uint8_t* masks) {
  using S = typename B::Simd;
  const PairJob job = given;
  for (std::int64_t k = job.begin; k < job.end; k += 8) {
    unsigned bits = 0;
    for (int lane = 0; lane < 8; lane += S::kWidth) {
      typename S::Real dx, dy, dz, reach;
      B::template gather_positions<Dim>(job, k + lane, dx, dy, dz, reach);
      if constexpr (Periodic) {
        dx = nearest_image<S>(dx, job.box.length[0], job.box.inverse[0]);
        dy = nearest_image<S>(dy, job.box.length[1], job.box.inverse[1]);
        if constexpr (Dim == 3) dz = nearest_image<S>(dz, job.box.length[2], job.box.inverse[2]);
      }
      reach = reach + S::set(margin);
      auto d2 = dx * dx + dy * dy;
      if constexpr (Dim == 3) d2 = d2 + dz * dz;
      bits |= S::bits(S::less(d2, reach * reach)) << lane;
    }
    masks[(k - job.begin) / 8] = static_cast<std::uint8_t>(bits);
  }
}

template <class B>
NarrowKernel pick_narrow(int dim, bool periodic) {
  if (dim == 2) return periodic ? &narrow<B, 2, true> : &narrow<B, 2, false>;
  return periodic ? &narrow<B, 3, true> : &narrow<B, 3, false>;
}

NarrowKernel pick_narrow_scalar(int dim, bool periodic);
NarrowKernel pick_narrow_avx2(int dim, bool periodic);
NarrowKernel pick_narrow_avx512(int dim, bool periodic);

}  // namespace barchan::kernels
