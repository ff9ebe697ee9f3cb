#pragma once

#include <cstdint>

#include <barchan/core/base/exact_sum.hpp>

namespace barchan {

/// Sums over a brick, added over bricks and ranks in any order.
struct Measures {
  ExactSum kinetic, elastic, gravitational;  ///< [J]
  ExactSum momentum[3];                      ///< [N·s]
  std::int64_t contacts = 0;                 ///< touching pairs without a bond, each once
  std::int64_t bonds = 0, broken_bonds = 0;
  double max_overlap = 0.0;        ///< [m], with particles or walls
  double max_overlap_share = 0.0;  ///< of the smaller radius
  double max_speed = 0.0;          ///< [m/s]
  double max_inverse_mass = 0.0;   ///< of the lightest particle [1/kg]
  void add(const Measures& other);
};

/// How far particles have come since the last rebuild, and how fast they are. A distance beyond
/// half the skin that was reached between a check and the rebuild it led to is told by the next
/// check.
struct Travel {
  double distance2 = 0.0;  ///< largest squared displacement [m²]
  double speed2 = 0.0;     ///< largest squared speed [m²/s²]
};

}  // namespace barchan
