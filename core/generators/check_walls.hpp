#pragma once

#include <optional>
#include <string>
#include <vector>

#include <barchan/core/links/wall_shape.hpp>
#include <barchan/core/model/model.hpp>

namespace barchan {

/// Says how a particle lies in a wall, where the wall reaches in by more than kGrossOverlap of the
/// radius: "particle 7 at (1, 2) has its centre on wall 'lid'". Fixed particles meet loaded plates
/// only. Pure.
/// @param foot  of the particle's centre on the wall
[[nodiscard]] std::optional<std::string> intrusion(const WallSpec& wall, const WallFoot& foot,
                                                   const ParticleData& particle, int dimension);

/// Checks walls against the particles of the start. Walls of later stages are held against fixed
/// particles alone: the others will have moved.
/// Pure. @throws InputError with the wall's place in the deck, naming wall and particle
void check_walls(const Model& model, const ParticleSet& set);

/// Particles of the start in which walls of later stages would appear, if they stayed where they
/// are: one sentence a wall. Pure.
[[nodiscard]] std::vector<std::string> walls_to_come_in_particles(const Model& model,
                                                                  const ParticleSet& set);

}  // namespace barchan
