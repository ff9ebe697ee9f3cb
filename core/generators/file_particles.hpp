#pragma once

#include <vector>

#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan {

/// Reads the file of a source, with densities as this model means them, and its bonds under the
/// laws of the deck.
/// @throws InputError: see read_particles; bonds of a type without law in the deck, or of none
/// where the source names one; a bond_gap where the file has bonds
[[nodiscard]] ParticleFile read_source(const Model& model, const ParticleSource& source,
                                       const FileSource& kind);

/// What a user should know of a file, a line each, with its name: what was not used, and a box that
/// is not the domain.
[[nodiscard]] std::vector<std::string> notes_on(const Model& model, const ParticleFile& file);

}  // namespace barchan
