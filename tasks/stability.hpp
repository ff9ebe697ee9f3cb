#pragma once

#include <span>
#include <string>
#include <vector>

#include <barchan/core/model/model.hpp>

namespace barchan {

/// One limit on the time step.
struct StepLimit {
  std::string what;  ///< such as "contact soil–duct", "damping soil–soil", "bond link, stretching"
  double step = 0.0;  ///< [s]
};

/// The limits on the time step of the explicit scheme, smallest first.
///
/// With mass m, stiffness k and dashpot c the leapfrog with a lagging velocity is stable for
///
///   dt <= (sqrt(c² + 4·m·k) − c) / k      2·sqrt(m/k) without dashpot, 2·m/c without spring
///
/// - "contact" and "damping": a pair of the lightest particles of these materials, without and with
///   the dashpot; "tangential": the same with kt, ct and the mass that sliding and rolling have
///   together; "wall": a particle against a material of infinite mass. A particle in a packing
///   touches several others and is stiffer than a pair by up to 3 (disks) or 4 (spheres) in k and
///   c: hence kAdvisedShare.
/// - "bond": every particle with all of its bonds, its partners moving against it, exact for a pair
///   and for a long chain; stretching, shearing (with rotation) and bending separately.
/// - "plate": a loaded plate and what touches it: as many particles of a material as fit side by
///   side on both of its faces, each moving against the plate.
/// @param particles  fixed ones count as infinitely heavy
/// Pure. Same on every rank.
std::vector<StepLimit> step_limits(const Model& model, const ParticleSet& particles);

/// Share of the limit up to which a packing of many contacts is safe and accurate.
inline constexpr double kAdvisedShare = 0.2;

/// Refuses a time step beyond the smallest limit, unless the model allows it.
/// Errors: InputError with the limit and the largest step that would do.
void check_time_step(const Model& model, std::span<const StepLimit> limits);

}  // namespace barchan
