#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <barchan/core/model/model.hpp>

namespace barchan {

/// Share of the limit up to which a packing of many contacts is safe and accurate.
inline constexpr double kAdvisedShare = 0.2;

/// One limit on the time step.
struct StepLimit {
  std::string what;  ///< such as "contact soil–duct", "damping soil–soil", "bond link, stretching"
  double step = 0.0;                  ///< [s]
  double safe_share = kAdvisedShare;  ///< of heat 1: its limit has as many contacts as there may be
  [[nodiscard]] double safe() const { return safe_share * step; }
};
/// The one whose safe step is the smallest. @pre there are limits
[[nodiscard]] const StepLimit& tightest(std::span<const StepLimit> limits);

/// The limits on the time step of the explicit scheme, smallest first.
///
/// With mass m, stiffness k and dashpot c the leapfrog with a lagging velocity is stable for
///
///   dt <= (sqrt(c² + 4·m·k) − c) / k      2·sqrt(m/k) without dashpot, 2·m/c without spring
///
/// - "contact" and "damping": a pair of the lightest particles of these materials, without and with
///   the dashpot; "tangential": the same with kt, ct and the mass that sliding and rolling have
///   together; "wall": a particle against a material of infinite mass. Where stiffness grows with
///   overlap: as stiff as an impact at contact.reference_speed makes it. A particle in a packing
///   touches several others and is stiffer than a pair by up to 3 (disks) or 4 (spheres) in k and
///   c: hence kAdvisedShare.
/// - "bond": every particle with all of its bonds, its partners moving against it, exact for a pair
///   and for a long chain; stretching, shearing (with rotation) and bending separately.
/// - "plate": a loaded plate and what touches it: as many particles of a material as fit side by
///   side on both of its faces, each moving against the plate.
/// - "heat": what particles of a material conduct, see heat_limits().
/// @param particles  fixed ones count as infinitely heavy
/// Pure. Same on every rank.
std::vector<StepLimit> step_limits(const Model& model, const ParticleSet& particles);

/// What the stable step takes for the hardest impact, where stiffness grows with overlap.
struct ReferenceImpact {
  double speed = 0.0;     ///< [m/s]
  double overlap = 0.0;   ///< the largest share of a smaller radius
  double duration = 0.0;  ///< of the shortest contact [s]
};
/// None where stiffness is the same at any overlap. Pure. Same on every rank.
std::optional<ReferenceImpact> reference_impact(const Model& model, const ParticleSet& particles);

/// Rayleigh times: how long a wave along the surface of a particle takes from pole to pole,
/// material by material where moduli are known, shortest first. Advice, and no limit: a share
/// kAdvisedShare of it is the custom. Source: Li, Xu & Thornton 2005,
/// doi:10.1016/j.powtec.2005.09.002. Pure. Same on every rank.
std::vector<StepLimit> wave_times(const Model& model, const ParticleSet& particles);

/// Refuses a time step beyond the smallest limit, unless the model allows it.
/// Errors: InputError with the limit and the largest step that would do.
void check_time_step(const Model& model, std::span<const StepLimit> limits);

}  // namespace barchan
