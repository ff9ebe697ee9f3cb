#pragma once

#include <cstdint>

#include <barchan/tasks/run_parts.hpp>
#include <barchan/tasks/stages.hpp>

namespace barchan {

/// Shows the walls of the present stage. @return whether one appeared, so that lists must be made
/// anew. Collective. Errors: AgreedError for a wall that appears where a particle is: it would
/// throw it out.
template <int Dim>
bool show_walls(RunParts<Dim>& run, const Stages& stages, std::int64_t step);

}  // namespace barchan
