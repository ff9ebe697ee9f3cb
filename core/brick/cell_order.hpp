#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <barchan/core/brick/brick.hpp>

namespace barchan {

/// An order of rows by cells: those of the rim first, then by keys; within a cell any.
struct CellOrder {
  std::vector<std::int32_t>
      source;  ///< of every row where it comes from, then the source rows that have left
  std::vector<std::int32_t> new_row;  ///< of every source row; -1: left
  std::int32_t num_owned = 0, num_rim = 0;
};

/// @param way  of every source row: Leavers::Stays, or else it has left
template <int Dim>
[[nodiscard]] CellOrder order_by_cells(const Brick<Dim>& brick, std::span<const std::int8_t> way);

/// Which rows are beside cuts. @pre rows by cells
template <int Dim>
void place_bands(Brick<Dim>& brick);

/// The rows that each link sends, by ascending keys. @pre rows by cells, in the index
template <int Dim>
void find_runs(Brick<Dim>& brick);

/// The rows of the slab so many slabs behind the one beside a cut of strips. @pre rows by cells
template <int Dim>
[[nodiscard]] Rows slab_behind(const Brick<Dim>& brick, Side side, int number);

extern template CellOrder order_by_cells(const Brick<2>&, std::span<const std::int8_t>);
extern template CellOrder order_by_cells(const Brick<3>&, std::span<const std::int8_t>);
extern template void place_bands(Brick<2>&);
extern template void place_bands(Brick<3>&);
extern template void find_runs(Brick<2>&);
extern template void find_runs(Brick<3>&);

}  // namespace barchan
