#pragma once

#include <string>
#include <vector>

#include <barchan/core/model.hpp>

namespace barchan {

/// One limit on the time step.
struct StepLimit {
  std::string what;  ///< such as "contact soil–duct", "damping soil–soil", "bond link"
  double step = 0.0;  ///< [s]
};

/// What keeps the explicit scheme stable: for every pair of materials that can meet 2·sqrt(m_eff/kn) with the
/// dashpot's share, for every bond law the same with its stiffnesses; smallest first.
///
/// With mass m_eff, stiffness k and dashpot c the leapfrog with a lagging velocity is stable for
///   dt <= (sqrt(c² + 4·m·k) − c) / k.
std::vector<StepLimit> step_limits(const Model& model, const ParticleSet& particles);

/// Default skin: a fixed share of the mean radius (docs/performance.md has the sweep).
double default_skin(const ParticleSet& particles);

}  // namespace barchan
