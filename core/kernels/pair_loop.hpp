#pragma once

#include <barchan/core/contact_law.hpp>
#include <barchan/core/kernels/pair_job.hpp>

namespace barchan::kernels {

// The pair loop, the same for every vector width. B (batch_*.hpp) gathers records into a PairState, looks
// constants up and scatters forces, in list order; the law is in contact_law.hpp.

enum Flags { kUsesMass = 1, kPeriodic = 2, kOneLaw = 4, kKeep = 8, kNumFlags = 16 };

template <class S>
[[gnu::always_inline]] inline typename S::Real nearest_image(typename S::Real d, double length, double inverse) {
  return d - S::set(length) * S::round(d * S::set(inverse));
}

template <class B, int Dim, int F>
void run_pairs(const PairJob& job) {
  using S = typename B::Simd;
  constexpr bool kMass = (F & kUsesMass) != 0;
  const auto dt = S::set(job.dt);
  const auto tables = B::template tables<kMass, (F & kOneLaw) != 0>(job.laws);
  for (std::int64_t k = job.begin; k < job.end; k += S::kWidth) {
    PairState<S, Dim> pair;
    B::gather(job, k, pair);
    if constexpr ((F & kPeriodic) != 0) {
      pair.dx = nearest_image<S>(pair.dx, job.box.length[0], job.box.inverse[0]);
      pair.dy = nearest_image<S>(pair.dy, job.box.length[1], job.box.inverse[1]);
      if constexpr (Dim == 3) pair.dz = nearest_image<S>(pair.dz, job.box.length[2], job.box.inverse[2]);
    }
    const auto constants = B::template constants<kMass, (F & kOneLaw) != 0>(tables, job.code + k);
    PairForce<S, Dim> force;
    B::template respond_with_spring<kMass, Dim>(job, k, constants, pair, dt, force);
    if constexpr ((F & kKeep) != 0) B::keep(job, k, force);
    B::scatter(job, k, force);
  }
}

/// Kernels by flags, for one batch policy and dimension.
template <class B, int Dim>
PairKernel pick(int flags) {
  static constexpr PairKernel kTable[kNumFlags] = {
      &run_pairs<B, Dim, 0>,  &run_pairs<B, Dim, 1>,  &run_pairs<B, Dim, 2>,  &run_pairs<B, Dim, 3>,
      &run_pairs<B, Dim, 4>,  &run_pairs<B, Dim, 5>,  &run_pairs<B, Dim, 6>,  &run_pairs<B, Dim, 7>,
      &run_pairs<B, Dim, 8>,  &run_pairs<B, Dim, 9>,  &run_pairs<B, Dim, 10>, &run_pairs<B, Dim, 11>,
      &run_pairs<B, Dim, 12>, &run_pairs<B, Dim, 13>, &run_pairs<B, Dim, 14>, &run_pairs<B, Dim, 15>};
  return kTable[flags];
}

PairKernel pick_scalar(int dim, int flags);
PairKernel pick_avx2(int dim, int flags);
PairKernel pick_avx512(int dim, int flags);

}  // namespace barchan::kernels
