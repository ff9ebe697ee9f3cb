#include <barchan/tasks/cuts.hpp>

#include <barchan/comm/topology/strips.hpp>

namespace barchan {

Cuts equal_cuts(const CellLoads& loads, const CutShape& shape) {
  Cuts cuts;
  for (int axis = 0; axis < 3; ++axis)
    cuts[static_cast<std::size_t>(axis)] =
        cut_equal(loads.along(axis), shape.along(axis), min_cells(shape));
  return cuts;
}

void move_cuts(Cuts& cuts, const CellLoads& loads, const CutShape& shape) {
  for (int axis = 0; axis < 3; ++axis) {
    if (shape.along(axis) == 1) continue;
    auto& along = cuts[static_cast<std::size_t>(axis)];
    along = recut(along, loads.along(axis), shape.along(axis), min_cells(shape));
  }
}

}  // namespace barchan
