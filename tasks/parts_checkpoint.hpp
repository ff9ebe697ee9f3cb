#pragma once

#include <cstdint>

#include <barchan/core/checkpoint/state.hpp>
#include <barchan/tasks/checkpoint_keeper.hpp>
#include <barchan/tasks/checkpoint_load.hpp>
#include <barchan/tasks/run_parts.hpp>
#include <barchan/tasks/step_graph.hpp>

namespace barchan {

// The parts of a run into a checkpoint, and out of one.

/// @pre ghosts are up to date. @param wall_outrun  see outrun_share
template <int Dim>
void copy_lanes(RunParts<Dim>& run, StepGraph<Dim>& graph, double wall_outrun,
                CheckpointCopy& copy);
/// Walls, scale and fingerprint.
template <int Dim>
void save_parts(const RunParts<Dim>& run, CheckpointState& state);

/// What lists follow from, in a run that continues with this model.
[[nodiscard]] WorldScale scale_of(const CheckpointState& state, const Model& model);
/// Walls, particles, lists. @return how many particles there are. Collective. Errors: InputError,
/// CommonError when something is missing.
template <int Dim>
[[nodiscard]] std::int64_t restore_parts(RunParts<Dim>& run, const OpenCheckpoint& checkpoint);

}  // namespace barchan
