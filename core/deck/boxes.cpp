#include <barchan/core/deck/boxes.hpp>

#include <fmt/format.h>

namespace barchan::deck {

namespace {
constexpr const char* kAxisNames[] = {"x", "y", "z"};
}

Box read_corners(const TableReader& table, std::string_view what) {
  Box box{table.vector("lo"), table.vector("hi")};
  for (int axis = 0; axis < table.dimension(); ++axis) {
    if (!(box.hi[axis] > box.lo[axis])) {
      table.fail("hi",
                 fmt::format("{} is empty: along {} hi = {} is not above lo = {}", what,
                             kAxisNames[axis], box.hi[axis], box.lo[axis]),
                 "write the lower corner as lo, the upper as hi");
    }
  }
  return box;
}

Box read_box(const Node& node, int dimension, std::string_view what) {
  return read_corners(TableReader(node, dimension, "box"), what);
}

void check_inside(const Box& box, const Model& model, const SourcePlace& place,
                  std::string_view what) {
  for (int axis = 0; axis < model.dimension; ++axis) {
    const double slack = 1e-9 * (model.domain.hi[axis] - model.domain.lo[axis]);
    const bool is_inside = box.lo[axis] >= model.domain.lo[axis] - slack &&
                           box.hi[axis] <= model.domain.hi[axis] + slack;
    if (!is_inside) {
      throw InputError(
          place,
          fmt::format("{} lies outside the domain: along {} it spans {} to {}, the domain {} to {}",
                      what, kAxisNames[axis], box.lo[axis], box.hi[axis], model.domain.lo[axis],
                      model.domain.hi[axis]),
          "move it, or make the domain larger");
    }
  }
}

double measure(const Box& box, int dimension) {
  double product = 1.0;
  for (int axis = 0; axis < dimension; ++axis) product *= box.hi[axis] - box.lo[axis];
  return product;
}

}  // namespace barchan::deck
