#pragma once

#include <array>
#include <cstddef>

namespace barchan {

enum class Side : int { Left = 0, Right = 1 };
constexpr std::array<Side, 2> kSides{Side::Left, Side::Right};

/// Of this side's element in an array of two.
constexpr std::size_t index_of(Side side) {
  return static_cast<std::size_t>(side);
}

constexpr Side opposite(Side side) {
  return side == Side::Left ? Side::Right : Side::Left;
}
constexpr const char* name_of(Side side) {
  return side == Side::Left ? "left" : "right";
}

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
