#pragma once

#include <barchan/core/kernels/pair_job.hpp>
#include <barchan/core/laws/contact.hpp>
#include <barchan/core/laws/laws.hpp>

namespace barchan::kernels {

// The pair loop, the same for every vector width. B (batch_*.hpp) gathers records into a PairState,
// looks constants up and scatters forces; the laws are in laws/*.hpp.

/// A kernel's variant: the level of its law in the low bits, then flags.
enum Flags { kLevel = 3, kPeriodic = 4, kOneRow = 8, kNumVariants = 16 };

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

template <class S, int Dim>
[[gnu::always_inline]] inline void make_contribution(typename S::Mask touching,
                                                     PairForces<S, Dim>& f) {
  make_contribution<S>(touching, f.first);
  make_contribution<S>(touching, f.second);
}

/// Number 0 of the history of pair k and those after it.
template <class S, int Length>
[[gnu::always_inline]] inline double* history_at(double* histories, std::int64_t k) {
  if constexpr (S::kWidth == 8 || Length == 1) return histories + Length * k;
  return histories + 8 * Length * (k / 8) + k % 8;
}

/// The law, with the history that is kept there.
template <class Law, class S, int Level, int Dim, class Force>
[[gnu::always_inline]] inline typename S::Mask respond_with_history(
    double* kept, const typename Law::template Constants<S>& constants,
    const typename Law::template State<S, Dim>& pair, typename S::Real dt, Force& force) {
  constexpr int kLength = Law::template kHistory<Dim>.length;
  if constexpr (S::kWidth == 1 && kLength == 1) {  // in place: pairs that do not touch load nothing
    auto& number = *reinterpret_cast<typename S::Real(*)[1]>(kept);
    return Law::template respond<S, Level>(constants, pair, dt, number, force);
  } else {
    typename S::Real numbers[kLength];
    for (int c = 0; c < kLength; ++c) numbers[c] = S::load(kept + 8 * c);
    const auto touching = Law::template respond<S, Level>(constants, pair, dt, numbers, force);
    for (int c = 0; c < kLength; ++c) S::store(kept + 8 * c, numbers[c]);
    return touching;
  }
}

template <class Law, class B, int Dim, int F>
void run_pairs(const PairJob& given) {
  const PairJob job =
      given;  // a copy that no store can alias, so that its pointers stay in registers
  using S = typename B::Simd;
  using Force = typename Law::template Force<S, Dim>;
  constexpr int kLevelOfLaw = F & kLevel;
  constexpr bool kUniform = (F & kOneRow) != 0;
  const auto dt = S::set(job.dt);
  const auto tables = B::template tables<Law, kLevelOfLaw, kUniform>(job.laws);
  for (std::int64_t k = job.begin; k < job.end; k += S::kWidth) {
    typename Law::template State<S, Dim> pair;
    B::gather(job, k, pair);
    if constexpr ((F & kPeriodic) != 0) {
      pair.dx = nearest_image<S>(pair.dx, job.box.length[0], job.box.inverse[0]);
      pair.dy = nearest_image<S>(pair.dy, job.box.length[1], job.box.inverse[1]);
      if constexpr (Dim == 3)
        pair.dz = nearest_image<S>(pair.dz, job.box.length[2], job.box.inverse[2]);
    }
    const auto& constants = B::template constants<Law, kLevelOfLaw, kUniform>(tables, job.code + k);
    Force force;
    double* kept = history_at<S, Law::template kHistory<Dim>.length>(job.history, k);
    const auto touching =
        respond_with_history<Law, S, kLevelOfLaw, Dim>(kept, constants, pair, dt, force);
    if (!S::any(touching)) continue;
    make_contribution<S>(touching, force);
    B::template scatter<kHasTwoTorques<Force>>(job, k, first_of(force), second_of(force));
  }
}

/// Kernels by variant, for one law, batch policy and dimension.
template <class Law, class B, int Dim, int F = 0>
PairKernel pick(int variant) {
  if constexpr (F < kNumVariants) {
    if constexpr ((F & kLevel) < static_cast<int>(Law::kNumLevels)) {
      if (variant == F) return &run_pairs<Law, B, Dim, F>;
    }
    return pick<Law, B, Dim, F + 1>(variant);
  } else {
    return nullptr;
  }
}

template <class Law, class B>
PairKernel pick_in(int dim, int variant) {
  if (dim == 3) return pick<Law, B, 3>(variant);
  if constexpr (kIsFor<Law, 2>) return pick<Law, B, 2>(variant);
  return nullptr;
}

// A law's kernels of one width stand in a file of their own: what a compiler makes of one law does
// not depend on others.
template <class Law>
PairKernel pick_scalar(int dim, int variant);
template <class Law>
PairKernel pick_avx2(int dim, int variant);
template <class Law>
PairKernel pick_avx512(int dim, int variant);

}  // namespace barchan::kernels
