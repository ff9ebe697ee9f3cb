#pragma once

#include <array>
#include <cstdint>

#include <barchan/core/base/rows.hpp>
#include <barchan/core/particles/particle_store.hpp>
#include <barchan/core/search/cell_box.hpp>
#include <barchan/core/search/cell_rows.hpp>

namespace barchan {

/// The rows of every cell of a box, and of the cells around it.
///
///   own    |   | lo . . . hi-1 |   |      a cell more on either side along axes that are cut,
///   covers | g | o   o   o   o | g |      around the end where the axis is periodic
template <int Dim>
class CellIndex {
 public:
  /// No rows yet.
  /// @param num_rows  of the box itself
  void cover(const Grid<Dim>& grid, const CellBox<Dim>& box, std::int64_t num_rows);
  /// @pre the rows of a cell stand together, and lie in what is covered
  void add(const Grid<Dim>& grid, const ParticleStore<Dim>& store, Rows rows);

  /// Of a cell that is covered.
  [[nodiscard]] Rows rows(const CellAt<Dim>& at) const { return rows_.of(place(at)); }
  [[nodiscard]] std::size_t bytes() const { return rows_.bytes(); }

 private:
  template <int>
  friend class Neighbourhood;

  /// Along one axis, from `first` on, around the end.
  struct Axis {
    int first = 0, length = 0, cells = 0;
    bool wraps = false;    ///< all of a periodic axis is covered
    bool is_ring = false;  ///< periodic

    [[nodiscard]] int local(int c) const { return c >= first ? c - first : c - first + cells; }
  };
  [[nodiscard]] std::int64_t place(const CellAt<Dim>& at) const {
    std::int64_t p = axes_[0].local(at[0]);
    for (std::size_t k = 1; k < Dim; ++k) p = p * axes_[k].length + axes_[k].local(at[k]);
    return p;
  }

  std::array<Axis, Dim> axes_{};
  CellRows rows_;
};

/// The rows of the cells around one cell, its own among them, as ascending ranges.
template <int Dim>
class Neighbourhood {
 public:
  std::array<Rows, 32> ranges;
  int count = 0;
  bool wraps = false;  ///< some lie around an end of the box

  /// @param wanted  other rows are left out
  void collect(const CellIndex<Dim>& index, const CellAt<Dim>& at, Rows wanted);

 private:
  /// Of one axis, as the index places them.
  struct Steps {
    std::array<int, 3> local;
    int count = 0;
  };
  [[nodiscard]] Steps steps(const typename CellIndex<Dim>::Axis& axis, int c);
  void add(Rows rows, Rows wanted);
};

extern template class CellIndex<2>;
extern template class CellIndex<3>;
extern template class Neighbourhood<2>;
extern template class Neighbourhood<3>;

}  // namespace barchan
