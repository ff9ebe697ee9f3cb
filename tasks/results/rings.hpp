#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <barchan/core/model/model.hpp>
#include <barchan/core/model/particle_source.hpp>
#include <barchan/tasks/simulation.hpp>

namespace barchan {

/// The disks of one ring: ids follow each other.
struct Ring {
  std::string name;
  std::int64_t first_id = 0, last_id = 0;
};

/// The rings of a deck: ring1, ring2, ... @param begins  see make_particles
[[nodiscard]] std::vector<Ring> find_rings(std::span<const ParticleSource> sources,
                                           std::span<const std::size_t> begins,
                                           const ParticleSet& particles);

/// Extent of every ring, largest less smallest coordinate of its disks' centres: x and y of the
/// first, of the second, … [m]. Along a periodic axis the shortest stretch that holds all centres.
/// None where no disk of the ring is left. Collective.
[[nodiscard]] std::vector<std::optional<double>> ring_diameters(const Simulation& simulation,
                                                                std::span<const Ring> rings);

}  // namespace barchan
