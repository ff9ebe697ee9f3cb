#pragma once

#include <string>

#include <barchan/core/model/model.hpp>

namespace barchan {

/// The unit of all sums of contact forces. A sum starts from the rounder M, whose neighbours are
/// one grain away, so that every addition rounds what it adds to a multiple of the grain:
///
///   M + f1 + f2 + …  =  M + r(f1) + r(f2) + …,   M = 1.5·2^52·size,   F = the sum − M, exactly
///
/// r does not depend on what is in the sum, unless f is a tie, half-way between two multiples; so
/// the last bit of every f is set, which no tie has. A sum that rounds nothing else has no order,
/// and no list, cut, thread or schedule is in its bits.
///
/// This holds while all partial sums of f stay within ±2^51·size. That follows from a bound on the
/// sum of the sizes of all contributions to a row, which is summed along with them and watched in
/// every step.
/// Source: Demmel & Nguyen 2013, doi:10.1109/ARITH.2013.9 (pre-rounding).
struct ForceGrain {
  double size = 1.0;  ///< a power of two [N]

  /// M [N].
  [[nodiscard]] double rounder() const { return 0x1.8p52 * size; }
  /// Largest sum of sizes over the contributions to one row; none has a larger component [N].
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
