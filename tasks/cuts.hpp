#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <barchan/core/search/cell_box.hpp>
#include <barchan/tasks/cut_shape.hpp>
#include <barchan/tasks/lane_map.hpp>

namespace barchan {

/// How many particles have each coordinate of a cell, axis after axis.
class CellCounts {
 public:
  /// @param cells  of the grid along each axis
  explicit CellCounts(const std::array<int, 3>& cells) {
    for (std::size_t k = 0; k < 3; ++k)
      begin_[k + 1] = begin_[k] + static_cast<std::size_t>(cells[k]);
    counts_.resize(begin_[3]);
  }
  template <int Dim>
  void add(const CellAt<Dim>& cell) {
    for (std::size_t k = 0; k < Dim; ++k) ++counts_[begin_[k] + static_cast<std::size_t>(cell[k])];
  }
  [[nodiscard]] std::span<std::int64_t> all() { return counts_; }
  [[nodiscard]] std::span<const std::int64_t> along(int axis) const {
    const auto k = static_cast<std::size_t>(axis);
    return std::span(counts_).subspan(begin_[k], begin_[k + 1] - begin_[k]);
  }

 private:
  std::array<std::size_t, 4> begin_{};
  std::vector<std::int64_t> counts_;
};

/// Cuts for equal counts along each axis. Pure. @pre they fit
[[nodiscard]] Cuts equal_cuts(const CellCounts& counts, const CutShape& shape);

/// Moves cuts where lanes have drifted apart; a cut stays between the old cuts beside it, so that a
/// particle only ever moves to a lane that touches its old one. Pure.
void move_cuts(Cuts& cuts, const CellCounts& counts, const CutShape& shape);

}  // namespace barchan
