#pragma once

#include <array>
#include <cstddef>

namespace barchan {

/// The two ends of a strip, and of a lane, along the strip axis.
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

}  // namespace barchan
