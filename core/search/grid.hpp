#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <barchan/core/kernels/pair_job.hpp>
#include <barchan/core/model/model.hpp>

namespace barchan {

/// Squared distance between a point and the nearest image of another [m²].
template <int Dim>
[[gnu::always_inline]] inline double distance2(const PeriodicBox& box, const double* p,
                                               const double* q) {
  double d2 = 0.0;
  for (int c = 0; c < Dim; ++c) {
    double d = q[c] - p[c];
    const double boxes = d * box.inverse[c];
    if (std::abs(boxes) > 0.5) d -= box.length[c] * std::rint(boxes);  // rarely: rint is a call
    d2 += d * d;
  }
  return d2;
}

/// @param dimension  axes beyond it do not wrap
[[nodiscard]] PeriodicBox periodic_box(const Domain& domain, int dimension);

/// The one grid of a run: lists are built by its cells, and cuts between strips lie on its faces.
///
/// Cells are at least `cutoff` wide, so a particle's partners are in its own cell or in a
/// neighbouring one. A cell's key grows fastest along the last axis and slowest along the strip
/// axis; a slab is the layer of cells with one strip coordinate.
template <int Dim>
class Grid {
 public:
  Grid() = default;

  /// @param cutoff  reach of the candidate search [m]
  /// Cells cost nothing by themselves: indices keep those where particles are.
  Grid(const Domain& domain, double cutoff);

  [[nodiscard]] int num_slabs() const { return cells_[0]; }
  [[nodiscard]] std::int64_t slab_size() const { return slab_size_; }  ///< cells per slab
  [[nodiscard]] int axis(int k) const { return axis_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] int cells(int k) const { return cells_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] bool is_periodic(int k) const { return periodic_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] const PeriodicBox& box() const { return box_; }

  /// Grid coordinate along the k-th axis in sorting order (0 = strip axis); outside the domain: the
  /// last cell, or where the position is after going around.
  [[nodiscard]] int coordinate(const double* x, int k) const {
    const auto a = static_cast<std::size_t>(k);
    double c = (x[axis_[a]] - lo_[a]) * inverse_[a];
    if (periodic_[a] && !(c >= 0.0 && c < cells_[a])) c -= cells_[a] * std::floor(c / cells_[a]);
    const int top = cells_[a] - 1;
    return c >= top ? top : (c > 0.0 ? static_cast<int>(c) : 0);
  }
  /// Position along the first axis, within the box where that wraps [m].
  [[nodiscard]] double along_strips(const double* x) const {
    double wrapped[Dim];
    std::copy_n(x, Dim, wrapped);
    wrap(wrapped);
    return wrapped[axis_[0]];
  }
  /// The slab of such a position.
  [[nodiscard]] int slab_at(double along_strips) const {
    double x[Dim] = {};
    x[axis_[0]] = along_strips;
    return coordinate(x, 0);
  }
  /// Coordinates of the cell of a position.
  [[nodiscard]] std::array<int, Dim> cell(const double* x) const {
    std::array<int, Dim> at;
    for (int k = 0; k < Dim; ++k) at[static_cast<std::size_t>(k)] = coordinate(x, k);
    return at;
  }
  [[nodiscard]] std::int64_t key(const std::array<int, Dim>& cell) const {
    std::int64_t key = cell[0];
    for (int k = 1; k < Dim; ++k) key = key * cells(k) + cell[static_cast<std::size_t>(k)];
    return key;
  }
  [[nodiscard]] std::int64_t key(const double* x) const { return key(cell(x)); }
  /// Whether a position is within the domain; along periodic axes it always is.
  [[nodiscard]] bool contains(const double* x) const {
    for (int a = 0; a < Dim; ++a) {
      if (box_.inverse[a] == 0.0 && (x[a] < origin_[a] || x[a] > end_[a])) return false;
    }
    return true;
  }
  /// Brings a position back into the periodic box.
  void wrap(double* x) const {
    for (int a = 0; a < Dim; ++a) {
      if (box_.inverse[a] == 0.0) continue;
      const double boxes = (x[a] - origin_[a]) * box_.inverse[a];
      if (!(boxes >= 0.0 && boxes < 1.0)) x[a] -= box_.length[a] * std::floor(boxes);
      if (x[a] >= origin_[a] + box_.length[a]) x[a] = origin_[a];
    }
  }

 private:
  std::array<int, Dim> axis_{}, cells_{};
  std::array<bool, Dim> periodic_{};
  std::array<double, Dim> lo_{}, inverse_{};
  double origin_[3] = {}, end_[3] = {};
  PeriodicBox box_;
  std::int64_t slab_size_ = 1;
};

extern template class Grid<2>;
extern template class Grid<3>;

}  // namespace barchan
