#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <barchan/core/generators/grain.hpp>

namespace barchan {

/// The space that pairs are sought in: periodic axes wrap at lo and hi, others are endless.
struct PairSpace {
  int dimension = 2;
  Vec3 lo = Vec3::Zero();  ///< [m]
  Vec3 hi = Vec3::Zero();  ///< [m]
  std::array<bool, 3> periodic{};

  /// a − b by the nearest image; the ignored axis of 2D gives what it holds.
  [[nodiscard]] Vec3 difference(const Vec3& a, const Vec3& b) const {
    Vec3 d = a - b;
    for (int axis = 0; axis < dimension; ++axis) {
      if (!periodic[static_cast<std::size_t>(axis)]) continue;
      const double length = hi[axis] - lo[axis];
      d[axis] -= length * std::nearbyint(d[axis] / length);
    }
    return d;
  }
};

/// Calls `use(i, j)` once for each pair with a surface gap up to `gap` [m], until it returns false.
/// Linear in the number of grains however much their sizes differ: grains of similar size share a
/// grid of hashed cells, and a grain looks into its own grid and those of the larger ones. The
/// order is the same everywhere.
/// @pre positions are finite; gap >= 0; a periodic length is more than twice the largest reach
void for_each_close_pair(const PairSpace& space, std::span<const Grain> grains, double gap,
                         const std::function<bool(std::uint32_t, std::uint32_t)>& use);

}  // namespace barchan
