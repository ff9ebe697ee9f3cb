#pragma once

#include <cstdint>
#include <span>

namespace barchan {

/// 64-bit hash (XXH3) of one particle's id, position, velocity and angular velocity bits.
/// The sum over all particles, modulo 2^64, is the state digest: no gather, no order.
std::uint64_t particle_digest(std::int64_t id, std::span<const double> position,
                              std::span<const double> velocity, std::span<const double> omega);

}  // namespace barchan
