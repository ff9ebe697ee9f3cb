#pragma once

#include <vector>

#include <barchan/core/generators/grain.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan {

/// Most particles that a generator makes; more is taken for a slip in the deck.
inline constexpr double kMostParticles = 1e9;

/// Grains on a regular grid, row by row, x fastest. Sites whose grain could reach over the region's
/// end are left out.
/// @throws InputError at `place` when the region holds no site, or more than kMostParticles
[[nodiscard]] std::vector<Grain> make_lattice(const LatticeSource& source, int dimension,
                                              const SourcePlace& place);

}  // namespace barchan
