#pragma once

#include <barchan/core/kernels/pair_loop.hpp>
#include <barchan/core/kernels/search_job.hpp>

namespace barchan::kernels {

// Broad phase: distances of one particle to a range of rows. Hits are few and nobody can foretell
// them, so they are written without a branch.

template <class S, int Dim, bool Periodic>
int find_within_reach(const SearchJob& job, std::int32_t begin, std::int32_t end,
                      std::int32_t* found) {
  using Real = typename S::Real;
  int count = 0;
  for (std::int32_t j = begin; j < end; j += S::kWidth) {
    Real d2 = S::set(0.0);
    for (int c = 0; c < Dim; ++c) {
      Real d = S::load_unaligned(job.x[c] + (j - job.first)) - S::set(job.at[c]);
      if constexpr (Periodic) d = nearest_image<S>(d, job.box.length[c], job.box.inverse[c]);
      d2 = d2 + d * d;
    }
    const Real reach = S::load_unaligned(job.radius + (j - job.first)) + S::set(job.reach);
    unsigned bits = S::bits(S::less(d2, reach * reach));
    if (end - j < S::kWidth) bits &= (1U << (end - j)) - 1U;
    for (int q = 0; q < S::kWidth; ++q) {
      found[count] = j + q;
      count += static_cast<int>(bits >> q & 1U);
    }
  }
  return count;
}

template <class S>
SearchKernel pick_search(int dim, bool periodic) {
  if (dim == 2) return periodic ? &find_within_reach<S, 2, true> : &find_within_reach<S, 2, false>;
  return periodic ? &find_within_reach<S, 3, true> : &find_within_reach<S, 3, false>;
}

SearchKernel pick_search_scalar(int dim, bool periodic);
SearchKernel pick_search_avx2(int dim, bool periodic);
SearchKernel pick_search_avx512(int dim, bool periodic);

}  // namespace barchan::kernels
