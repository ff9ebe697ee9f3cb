#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <barchan/core/search/cell_box.hpp>
#include <barchan/tasks/cut_shape.hpp>
#include <barchan/tasks/lane_map.hpp>

namespace barchan {

/// What the particles with each coordinate of a cell weigh together, axis after axis.
class CellLoads {
 public:
  /// @param cells  of the grid along each axis
  explicit CellLoads(const std::array<int, 3>& cells) {
    for (std::size_t k = 0; k < 3; ++k)
      begin_[k + 1] = begin_[k] + static_cast<std::size_t>(cells[k]);
    loads_.resize(begin_[3]);
  }
  template <int Dim>
  void add(const CellAt<Dim>& cell, std::int64_t weight = 1) {
    for (std::size_t k = 0; k < Dim; ++k)
      loads_[begin_[k] + static_cast<std::size_t>(cell[k])] += weight;
  }
  [[nodiscard]] std::span<std::int64_t> all() { return loads_; }
  [[nodiscard]] std::span<const std::int64_t> along(int axis) const {
    const auto k = static_cast<std::size_t>(axis);
    return std::span(loads_).subspan(begin_[k], begin_[k + 1] - begin_[k]);
  }

 private:
  std::array<std::size_t, 4> begin_{};
  std::vector<std::int64_t> loads_;
};

/// Cuts for equal loads along each axis. Pure. @pre they fit
[[nodiscard]] Cuts equal_cuts(const CellLoads& loads, const CutShape& shape);

/// Moves cuts where lanes have drifted apart; a cut stays between the old cuts beside it, so that a
/// particle only ever moves to a lane that touches its old one. Pure.
void move_cuts(Cuts& cuts, const CellLoads& loads, const CutShape& shape);

}  // namespace barchan
