#pragma once

#include <barchan/core/brick/measures.hpp>
#include <barchan/tasks/simulation.hpp>

namespace barchan {

/// Holds energies, momentum, and forces and work of walls against the range of numbers.
/// @param measures  just measured. Errors: AgreedError, with what is too large, alike on every rank
void check_sums(const Simulation& simulation, const Measures& measures);

}  // namespace barchan
