#pragma once

#include <barchan/core/contact_law.hpp>
#include <barchan/core/kernels/pair_job.hpp>

namespace barchan::kernels {

// The pair loop, the same for every vector width. B (batch_*.hpp) gathers records into a PairState,
// looks constants up and scatters forces; the law is in contact_law.hpp.

/// A kernel's variant: Damping in the low bits, then flags.
enum Flags { kDamping = 3, kPeriodic = 4, kOneLaw = 8, kNumVariants = 16 };

template <class S>
[[gnu::always_inline]] inline typename S::Real nearest_image(typename S::Real d, double length,
                                                             double inverse) {
  return d - S::set(length) * S::round(d * S::set(inverse));
}

/// What is added to rows: zero where nothing touches; elsewhere with the last bit set, so that no
/// sum with a multiple of the grain is a tie (force_grain.hpp).
template <class S>
[[gnu::always_inline]] inline void make_contribution(typename S::Mask touching,
                                                     PairForce<S, 2>& f) {
  f.fx = S::where(touching, S::odd(f.fx));
  f.fy = S::where(touching, S::odd(f.fy));
  f.ft = S::where(touching, S::odd(f.ft));
  f.size = S::where(touching, f.size);
}

template <class S>
[[gnu::always_inline]] inline void make_contribution(typename S::Mask touching,
                                                     PairForce<S, 3>& f) {
  f.fx = S::where(touching, S::odd(f.fx));
  f.fy = S::where(touching, S::odd(f.fy));
  f.fz = S::where(touching, S::odd(f.fz));
  f.tx = S::where(touching, S::odd(f.tx));
  f.ty = S::where(touching, S::odd(f.ty));
  f.tz = S::where(touching, S::odd(f.tz));
  f.size = S::where(touching, f.size);
}

template <class B, int Dim, int F>
void run_pairs(const PairJob& given) {
  const PairJob job =
      given;  // a copy that no store can alias, so that its pointers stay in registers
  using S = typename B::Simd;
  constexpr auto kDamped = static_cast<Damping>(F & kDamping);
  constexpr bool kUniform = (F & kOneLaw) != 0;
  const auto dt = S::set(job.dt);
  const auto tables = B::template tables<kDamped, kUniform>(job.laws);
  for (std::int64_t k = job.begin; k < job.end; k += S::kWidth) {
    PairState<S, Dim> pair;
    B::gather(job, k, pair);
    if constexpr ((F & kPeriodic) != 0) {
      pair.dx = nearest_image<S>(pair.dx, job.box.length[0], job.box.inverse[0]);
      pair.dy = nearest_image<S>(pair.dy, job.box.length[1], job.box.inverse[1]);
      if constexpr (Dim == 3)
        pair.dz = nearest_image<S>(pair.dz, job.box.length[2], job.box.inverse[2]);
    }
    const auto& constants = B::template constants<kDamped, kUniform>(tables, job.code + k);
    PairForce<S, Dim> force;
    const auto touching =
        B::template respond_with_spring<kDamped, Dim>(job, k, constants, pair, dt, force);
    if (!S::any(touching)) continue;
    make_contribution<S>(touching, force);
    B::scatter(job, k, force);
  }
}

/// Kernels by variant, for one batch policy and dimension.
template <class B, int Dim, int F = 0>
PairKernel pick(int variant) {
  if constexpr (F < kNumVariants) {
    if constexpr ((F & kDamping) <= static_cast<int>(Damping::Critical)) {
      if (variant == F) return &run_pairs<B, Dim, F>;
    }
    return pick<B, Dim, F + 1>(variant);
  } else {
    return nullptr;
  }
}

PairKernel pick_scalar(int dim, int variant);
PairKernel pick_avx2(int dim, int variant);
PairKernel pick_avx512(int dim, int variant);

}  // namespace barchan::kernels
