#pragma once

#include <barchan/core/deck/table_reader.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan::deck {

/// Reads `lo` and `hi` of a table. Errors: InputError when the box is empty; `what` is its name
/// there.
Box read_corners(const TableReader& table, std::string_view what);

/// Reads a box `{ lo = ..., hi = ... }`.
Box read_box(const Node& node, int dimension, std::string_view what);

/// Errors: InputError at `place` when the box sticks out of the domain.
void check_inside(const Box& box, const Model& model, const SourcePlace& place,
                  std::string_view what);

/// Area (2D) or volume (3D).
double measure(const Box& box, int dimension);

}  // namespace barchan::deck
