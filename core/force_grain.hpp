#pragma once

#include <string>

#include <barchan/core/model.hpp>

namespace barchan {

/// The unit of all sums of contact forces: every contribution to a row is rounded once to a
/// multiple of it, and multiples of one power of two add without rounding. A sum that rounds
/// nothing has no order, so no list, cut, thread or schedule is in its bits.
///
///   rounded = (f + M) − M,   M = 1.5·2^52·size            f + M has no bits below `size`
///
/// This holds while |f| < 2^51·size (beyond it f and −f would round differently) and while partial
/// sums stay below 2^53·size. Both follow from one bound on the sum of the sizes of all
/// contributions to a row, which is summed along with them and watched in every step.
/// Source: Demmel & Nguyen 2013, doi:10.1109/ARITH.2013.9 (pre-rounding).
struct ForceGrain {
  double size = 1.0;  ///< a power of two [N]

  /// M, as the kernels take it [N].
  [[nodiscard]] double rounder() const { return 0x1.8p52 * size; }
  /// Largest sum of |fx| + |fy| (+ |fz|) over the contributions to one row [N].
  [[nodiscard]] double most() const { return 0x1.ffp50 * size; }
};

/// The grain of a run: the finest one with which a particle may bear the largest contact force, and
/// half of it from each of as many neighbours as fit around it.
///
/// The largest force is that of the stiffest law between two of the largest particles, overlapping
/// by limits.overlap_error of the smaller radius (2 where there is no limit: the centres meet), or
/// of its dashpot at the speed of the start and of a fall through the whole domain.
/// Pure; the same on every rank. @param particles  of the start
[[nodiscard]] ForceGrain force_grain(const Model& model, const ParticleSet& particles);

/// The grain of a run that continues with another limits.overlap_error: coarser by as much as the
/// limit is higher, and otherwise the same. Pure.
[[nodiscard]] ForceGrain grain_for_limit(const ForceGrain& grain, double limit_before,
                                         double limit_now);

/// Mass of the lightest particle that moves [kg]; infinite without any.
[[nodiscard]] double smallest_mass(const Model& model, const ParticleSet& particles);

/// The grain in words: what it is of the smallest weight, or the acceleration that it is to the
/// lightest particle.
[[nodiscard]] std::string describe(const ForceGrain& grain, const Model& model,
                                   const ParticleSet& particles);
/// A warning where the grain is more than 1e-4 of the smallest weight; empty: there is none.
[[nodiscard]] std::string coarse_grain_warning(const ForceGrain& grain, const Model& model,
                                               const ParticleSet& particles);

}  // namespace barchan
