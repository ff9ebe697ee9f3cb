#pragma once

#include <cmath>
#include <limits>

#include <barchan/core/kernels/row_job.hpp>
#include <barchan/core/particles/layout.hpp>

namespace barchan::kernels {

// Q holds half a record: four doubles. Sums of forces start from the rounder (force_grain.hpp),
// which is taken out first; the last lane sums sizes. A fixed particle has 1/m = 0 and feels no
// gravity either.

template <class Q, bool Damped>
[[gnu::always_inline]] inline typename Q::Real kicked(typename Q::Real v, typename Q::Real dv,
                                                      typename Q::Real alpha) {
  if constexpr (Damped) dv = dv - alpha * Q::copysign(Q::abs(dv), v);
  return v + dv;
}

template <class Q, int Dim, bool Damped>
RowSpeeds advance_rows(const RowJob& job) {
  const double k = job.kick, turn = Layout<Dim>::kSpinGain * k;
  auto top = Q::set(0.0);
  const auto alpha = Q::set(job.local_damping);
  const auto zero = Q::set(0.0);
  const double most = job.most_speed, any = std::numeric_limits<double>::infinity();
  const auto limit = Q::of(most, most, Dim == 3 ? most : any, any);
  auto fast = Q::beyond(zero, zero);
  const auto rounder = Q::of(job.rounder, job.rounder, job.rounder, 0.0);
  alignas(64) constexpr double kNone[8] = {};
  const double* extra = job.extra != nullptr ? job.extra : kNone;
  const std::int64_t stride = job.extra != nullptr ? Layout<Dim>::kForce : 0;
  auto top_force = zero;
  if constexpr (Dim == 2) {
    const auto gain = Q::of(k, k, turn, 0.0), drift = Q::of(job.dt, job.dt, 0.0, 0.0);
    const auto gravity = Q::of(job.gravity[0] * k, job.gravity[1] * k, 0.0, 0.0);
    for (std::int32_t i = job.begin; i < job.end; ++i, extra += stride) {
      double *x = job.motion + 8 * static_cast<std::int64_t>(i),
             *f = job.force + 4 * static_cast<std::int64_t>(i);
      const auto v = Q::load(x + 4), im = Q::last(v);
      const auto sum = Q::load(f);
      top_force = Q::max(top_force, sum);
      const auto dv =
          ((sum - rounder) + Q::load(extra)) * (im * gain) + Q::where_positive(im, gravity);
      const auto w = kicked<Q, Damped>(v, dv, alpha);
      fast = Q::either(fast, Q::beyond(w, limit));
      Q::store(x + 4, w);
      Q::store(x, Q::load(x) + drift * w);
      Q::store(f, rounder);
    }
  } else {
    const auto gain = Q::of(k, k, k, 0.0), drift = Q::of(job.dt, job.dt, job.dt, 0.0);
    const auto twist = Q::of(turn, turn, turn, 0.0);
    const auto gravity = Q::of(job.gravity[0] * k, job.gravity[1] * k, job.gravity[2] * k, 0.0);
    for (std::int32_t i = job.begin; i < job.end; ++i, extra += stride) {
      double *x = job.motion + 8 * static_cast<std::int64_t>(i),
             *f = job.force + 8 * static_cast<std::int64_t>(i);
      double* u = job.spin + 4 * static_cast<std::int64_t>(i);
      const auto v = Q::load(x + 4), im = Q::last(v);
      const auto sum = Q::load(f);
      top_force = Q::max(top_force, sum);
      const auto dv =
          ((sum - rounder) + Q::load(extra)) * (im * gain) + Q::where_positive(im, gravity);
      const auto w = kicked<Q, Damped>(v, dv, alpha);
      fast = Q::either(fast, Q::beyond(w, limit));
      Q::store(x + 4, w);
      top = Q::max(top, Q::abs(w));
      Q::store(x, Q::load(x) + drift * w);
      const auto s = Q::load(u);
      Q::store(u, kicked<Q, Damped>(
                      s, ((Q::load(f + 4) - rounder) + Q::load(extra + 4)) * (im * twist), alpha));
      Q::store(f, rounder);
      Q::store(f + 4, rounder);
    }
  }
  alignas(32) double speed[4], force[4];
  Q::store(speed, top);
  Q::store(force, top_force);
  return {std::sqrt(speed[0] * speed[0] + speed[1] * speed[1] + speed[2] * speed[2]),
          Q::has_any(fast), force[3]};
}

template <class Q>
RowKernel pick_rows(int dim, bool damped) {
  if (dim == 2) return damped ? &advance_rows<Q, 2, true> : &advance_rows<Q, 2, false>;
  return damped ? &advance_rows<Q, 3, true> : &advance_rows<Q, 3, false>;
}

RowKernel pick_rows_scalar(int dim, bool damped);
RowKernel pick_rows_avx2(int dim, bool damped);

}  // namespace barchan::kernels
