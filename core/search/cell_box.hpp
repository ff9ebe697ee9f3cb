#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <barchan/core/search/grid.hpp>

namespace barchan {

/// Coordinates of a cell, in the grid's order of axes.
template <int Dim>
using CellAt = std::array<int, Dim>;

template <int Dim>
[[nodiscard]] CellAt<Dim> cell_of_key(const Grid<Dim>& grid, std::int64_t key) {
  CellAt<Dim> at{};
  for (int k = Dim - 1; k > 0; --k) {
    at[static_cast<std::size_t>(k)] = static_cast<int>(key % grid.cells(k));
    key /= grid.cells(k);
  }
  at[0] = static_cast<int>(key);
  return at;
}

/// Cells [lo, hi) along each axis.
template <int Dim>
struct CellBox {
  CellAt<Dim> lo{}, hi{};

  [[nodiscard]] bool contains(const CellAt<Dim>& at) const {
    for (std::size_t k = 0; k < Dim; ++k) {
      if (at[k] < lo[k] || at[k] >= hi[k]) return false;
    }
    return true;
  }
  [[nodiscard]] int length(int k) const {
    return hi[static_cast<std::size_t>(k)] - lo[static_cast<std::size_t>(k)];
  }
  [[nodiscard]] std::int64_t size() const {
    std::int64_t n = 1;
    for (int k = 0; k < Dim; ++k) n *= length(k);
    return n;
  }
  /// Of a cell among those of the box, by keys.
  [[nodiscard]] std::size_t place(const CellAt<Dim>& at) const {
    std::int64_t p = at[0] - lo[0];
    for (int k = 1; k < Dim; ++k)
      p = p * length(k) + at[static_cast<std::size_t>(k)] - lo[static_cast<std::size_t>(k)];
    return static_cast<std::size_t>(p);
  }
  friend bool operator==(const CellBox&, const CellBox&) = default;
};

/// Slabs [begin, end), whole along the other axes.
template <int Dim>
[[nodiscard]] CellBox<Dim> box_of_slabs(const Grid<Dim>& grid, int begin, int end) {
  CellBox<Dim> box;
  for (int k = 0; k < Dim; ++k) box.hi[static_cast<std::size_t>(k)] = grid.cells(k);
  box.lo[0] = begin;
  box.hi[0] = end;
  return box;
}

/// Where a brick lies, and the bricks that its links lead to.
template <int Dim>
struct Placement {
  CellBox<Dim> box;
  std::vector<CellBox<Dim>> beyond;  ///< by link
};

/// Coordinates first, …, last.
struct CellSpan {
  int first = 0, last = -1;
};

/// The cells whose coordinates lie, axis by axis, in one of some spans, apart and ascending.
template <int Dim>
struct CellRegion {
  std::array<std::vector<CellSpan>, Dim> spans;

  [[nodiscard]] bool contains(const CellAt<Dim>& at) const {
    for (std::size_t k = 0; k < Dim; ++k) {
      const auto has = [&](const CellSpan& s) { return at[k] >= s.first && at[k] <= s.last; };
      if (std::none_of(spans[k].begin(), spans[k].end(), has)) return false;
    }
    return true;
  }
  [[nodiscard]] std::int64_t size() const {
    std::int64_t n = 1;
    for (const auto& along : spans) {
      std::int64_t length = 0;
      for (const CellSpan& s : along) length += s.last - s.first + 1;
      n *= length;
    }
    return n;
  }
  /// Calls f(cell) for each, by ascending keys.
  template <class F>
  void for_each(F&& f) const {
    CellAt<Dim> at{};
    visit(0, at, f);
  }

 private:
  template <class F>
  void visit(std::size_t k, CellAt<Dim>& at, F& f) const {
    for (const CellSpan& span : spans[k]) {
      for (int c = span.first; c <= span.last; ++c) {
        at[k] = c;
        if (k + 1 == Dim)
          f(at);
        else
          visit(k + 1, at, f);
      }
    }
  }
};

/// The cells of one box that touch another box, around the ends of periodic axes too: those that
/// the other one needs as ghosts.
template <int Dim>
[[nodiscard]] CellRegion<Dim> cells_beside(const Grid<Dim>& grid, const CellBox<Dim>& box,
                                           const CellBox<Dim>& other);

extern template CellRegion<2> cells_beside(const Grid<2>&, const CellBox<2>&, const CellBox<2>&);
extern template CellRegion<3> cells_beside(const Grid<3>&, const CellBox<3>&, const CellBox<3>&);

}  // namespace barchan
