#pragma once

#include <span>

namespace barchan {

struct Disk {
  double x = 0.0, y = 0.0, radius = 0.0;  ///< [m]
};

struct Rectangle {
  double lo[2] = {}, hi[2] = {};  ///< [m]
};

/// Area [m²] of the union of disks within a rectangle, in closed form: between two neighbouring
/// abscissae at which disks begin, end or cross each other or the rectangle's sides, the union is
/// bounded by the same arcs and sides.
[[nodiscard]] double disk_union_area(std::span<const Disk> disks, const Rectangle& rectangle);

}  // namespace barchan
