#pragma once

#include <string>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/tasks/run_options.hpp>

namespace barchan {

/// What callers give to a Simulation, before anything is made of it: the same on every rank (found
/// by hash), a model that can run, and a thread level of MPI that the threads need. Collective.
/// Errors: InputError, the same on every rank.
void check_input(const Communicator& communicator, const Model& model, const ParticleSet& particles,
                 const RunOptions& options);
/// The same for a checkpoint instead of particles.
void check_input(const Communicator& communicator, const Model& model,
                 const std::string& checkpoint, const RunOptions& options);

}  // namespace barchan
