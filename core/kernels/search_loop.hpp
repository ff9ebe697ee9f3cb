#pragma once

#include <barchan/core/kernels/pair_loop.hpp>
#include <barchan/core/kernels/search_job.hpp>

namespace barchan::kernels {

// Broad phase: distances of one particle to ranges of rows. Hits are few and nobody can foretell
// them, so they are written without a branch.

template <class S, int Dim, bool Wraps>
int find_in_ranges(const SearchJob& job, const Rows* ranges, int count, std::int32_t* found) {
  using Real = typename S::Real;
  Real at[Dim];
  for (int c = 0; c < Dim; ++c) at[c] = S::set(job.at[c]);
  const Real own_reach = S::set(job.reach);
  const std::int32_t* const begin = found;
  for (const Rows* range = ranges; range < ranges + count; ++range) {
    for (std::int32_t j = range->begin; j < range->end; j += S::kWidth) {
      const std::int64_t q = j - job.first;
      Real d2 = S::set(0.0);
      for (int c = 0; c < Dim; ++c) {
        Real d = S::load_unaligned(job.x[c] + q) - at[c];
        if constexpr (Wraps) d = nearest_image<S>(d, job.box.length[c], job.box.inverse[c]);
        d2 = d2 + d * d;
      }
      const Real reach = S::load_unaligned(job.radius + q) + own_reach;
      unsigned bits = S::bits(S::less(d2, reach * reach));
      if (range->end - j < S::kWidth) bits &= (1U << (range->end - j)) - 1U;
      found += S::write_set(bits, j, found);
    }
  }
  return static_cast<int>(found - begin);
}

template <class S, int Dim>
int find_within_reach(const SearchJob& job, const Rows* ranges, int count, std::int32_t* found) {
  return job.wraps ? find_in_ranges<S, Dim, true>(job, ranges, count, found)
                   : find_in_ranges<S, Dim, false>(job, ranges, count, found);
}

template <class S>
SearchKernel pick_search(int dim) {
  return dim == 2 ? &find_within_reach<S, 2> : &find_within_reach<S, 3>;
}

SearchKernel pick_search_scalar(int dim);
SearchKernel pick_search_avx2(int dim);
SearchKernel pick_search_avx512(int dim);

}  // namespace barchan::kernels
