#pragma once

#include <cstddef>

#include <barchan/core/model/model.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan {

inline constexpr double kTouchGap = 1e-6;  ///< over the sum of the radii

/// Appends the bonds that a source asks for by ParticleSource::bond: its pairs, else neighbours
/// along a ring, else what touches.
/// @param first  index of the source's first particle; its last one is the set's
/// @throws InputError at the source's place: pairs of unknown particles, a gap too wide for the
/// domain, no pair to link
void link_bonds(const Model& model, const ParticleSource& source, std::size_t first,
                ParticleSet& set);

}  // namespace barchan
