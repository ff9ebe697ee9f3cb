#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <barchan/core/model/model.hpp>

namespace barchan {

/// 64-bit hash (XXH3) of one particle's id, position, velocity and angular velocity bits, and of
/// its temperature's, where it has one.
/// The sum over all particles, modulo 2^64, is the state digest: no gather, no order.
std::uint64_t particle_digest(std::int64_t id, std::span<const double> position,
                              std::span<const double> velocity, std::span<const double> omega,
                              std::span<const double> temperature = {});

/// 64-bit hash (XXH3) of bytes.
std::uint64_t hash_of_bytes(std::span<const std::byte> bytes);

/// 64-bit hash (XXH3) of all that a set says of its particles and bonds, in their order.
std::uint64_t particle_set_hash(const ParticleSet& set);

}  // namespace barchan
