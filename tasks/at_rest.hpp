#pragma once

#include <barchan/core/model/model.hpp>
#include <barchan/tasks/run_parts.hpp>

// What limits the step of a run under way, on rank 0: particles without velocities.

namespace barchan {

/// All particles and bonds. Collective.
template <int Dim>
[[nodiscard]] ParticleSet gather_at_rest(const RunParts<Dim>& run);

/// Those that limit the step of others beside them: of every material and rank the two lightest, or
/// all where numbers count, which are those that touch a plate or conduct heat. Without bonds.
/// Collective.
template <int Dim>
[[nodiscard]] ParticleSet gather_lightest(const RunParts<Dim>& run);

}  // namespace barchan
