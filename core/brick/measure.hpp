#pragma once

#include <cstdint>
#include <vector>

#include <barchan/core/base/exact_sum.hpp>
#include <barchan/core/brick/brick.hpp>
#include <barchan/core/brick/measures.hpp>

// What is summed over a brick between steps. Ghosts are up to date, where pairs count.

namespace barchan {

template <int Dim>
[[nodiscard]] Measures measure(const Brick<Dim>& brick, const Vec3& gravity);
/// Of all walls force and torque as the next step will find them, and the work since the start.
template <int Dim>
[[nodiscard]] std::vector<WallSums> measure_walls(const Brick<Dim>& brick);
/// Since the last rebuild; needs no ghosts.
template <int Dim>
[[nodiscard]] Travel travel(const Brick<Dim>& brick);
/// Largest squared displacement since the last rebuild that a step was computed with: before its
/// drift [m²].
template <int Dim>
[[nodiscard]] double distance2_of_last_step(const Brick<Dim>& brick);
/// The sum of the particles' hashes (digest.hpp).
template <int Dim>
[[nodiscard]] std::uint64_t digest(const Brick<Dim>& brick, Rows rows);
template <int Dim>
[[nodiscard]] std::uint64_t digest(const Brick<Dim>& brick) {
  return digest(brick, Rows{0, brick.store.num_owned});
}

}  // namespace barchan
