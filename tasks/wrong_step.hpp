#pragma once

#include <cstdint>

#include <barchan/tasks/run_parts.hpp>
#include <barchan/tasks/step_graph.hpp>

namespace barchan {

/// The earliest of the graph's last steps in which a lane went wrong, the first being 1; 0: none.
template <int Dim>
[[nodiscard]] int wrong_step(const Strip<Dim>& strip, const StepGraph<Dim>& graph);

/// This rank alone knows of it: the others may be in the midst of the next step.
/// @param nth   what wrong_step() says, @param step  the same since the start of the run
/// Errors: StepError for the lowest ids of two that passed each other, or of a fast particle, or
/// for the particle that bore most.
template <int Dim>
[[noreturn]] void report_wrong_step(const RunParts<Dim>& run, const StepGraph<Dim>& graph, int nth,
                                    std::int64_t step);

}  // namespace barchan
