#pragma once

namespace barchan {

/// The numbers that a contact keeps from one step to the next: zero before it touches. What points
/// from the first particle to the second, or turns with them, changes its sign when the two swap.
struct History {
  int length = 0;      ///< numbers per contact, at most kMostHistory
  unsigned flips = 0;  ///< bit c: number c changes its sign

  /// What number c is multiplied by as seen from the other end.
  [[nodiscard]] constexpr double sign(int c, bool is_swapped) const {
    return is_swapped && (flips >> c & 1U) != 0 ? -1.0 : 1.0;
  }
};

inline constexpr int kMostHistory = 8;  ///< longest history of any law

}  // namespace barchan
