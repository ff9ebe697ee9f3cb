#pragma once

#include <cstddef>

#include <barchan/core/model/model.hpp>

namespace barchan {

/// Bytes that one rank of one thread has for these particles at the start: rows, lists, bonds.
/// Pure, without MPI. @pre the model and the particles are checked
[[nodiscard]] std::size_t memory_estimate(const Model& model, const ParticleSet& particles);

}  // namespace barchan
