#pragma once

#include <barchan/core/base/side.hpp>

namespace barchan {

/// Ranks of the strips beside this one; -1 = none. With a periodic strip axis the left of rank 0 is
/// the last rank; with two ranks both may be the same rank.
struct Neighbours {
  int left = -1;
  int right = -1;

  [[nodiscard]] constexpr int rank(Side side) const { return side == Side::Left ? left : right; }
  [[nodiscard]] constexpr bool has(Side side) const { return rank(side) >= 0; }
};

/// The neighbours of strip `rank` of `size`. A lone strip has none, periodic or not: its own image
/// is no message.
constexpr Neighbours strip_neighbours(int rank, int size, bool is_periodic) {
  if (size < 2) return {};
  Neighbours beside{rank - 1, rank + 1 < size ? rank + 1 : -1};
  if (is_periodic && beside.left < 0) beside.left = size - 1;
  if (is_periodic && beside.right < 0) beside.right = 0;
  return beside;
}

}  // namespace barchan
