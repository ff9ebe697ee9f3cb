#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <barchan/core/model/model.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan {

/// Makes the particles and bonds of a deck. Generated ids follow each other from the highest so
/// far, 1 at first; a file keeps its own. Centres on periodic axes end up in [lo, hi). The result
/// depends on nothing but the arguments and the files: every rank may make it for itself.
/// @throws InputError with the place in the deck or in the particle file: ids that are taken,
///         particles outside the domain, types without material, what does not fit into its region
[[nodiscard]] ParticleSet make_particles(const Model& model,
                                         std::span<const ParticleSource> sources);

/// The same. `begins` gets the index of every source's first particle, and at the end their number.
[[nodiscard]] ParticleSet make_particles(const Model& model,
                                         std::span<const ParticleSource> sources,
                                         std::vector<std::size_t>& begins);

/// Checks what came from generators or from a caller. @throws InputError naming the ids: a repeated
/// id, a centre outside the domain, radius or density not positive, values that are not finite, a
/// type without material, a bond to an unknown id or of an unknown law, or two particles that
/// overlap by more than kGrossOverlap of the smaller radius (unless they are bonded, or both
/// fixed).
/// @param place_of  where the particle of an index comes from, for the message
void check_particles(const Model& model, const ParticleSet& set,
                     const std::function<SourcePlace(std::size_t)>& place_of = {});

/// Where a particle of make_particles comes from: its line in a file or its entry in a list, else
/// its source. @param begins  of make_particles
[[nodiscard]] SourcePlace place_of_particle(std::span<const ParticleSource> sources,
                                            std::span<const std::size_t> begins, std::size_t index);

inline constexpr double kGrossOverlap = 0.5;

/// Is the centre in the domain? Both ends count.
[[nodiscard]] bool is_inside(const Domain& domain, const Vec3& position, int dimension);

}  // namespace barchan
