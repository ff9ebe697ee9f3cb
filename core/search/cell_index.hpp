#pragma once

#include <cstdint>
#include <vector>

#include <barchan/core/base/rows.hpp>
#include <barchan/core/particles/particle_store.hpp>
#include <barchan/core/search/grid.hpp>

namespace barchan {

/// Rows of every cell of consecutive slabs: cell c of the first slab's keys starts at start[c].
struct CellIndex {
  int slab_begin = 0, slab_end = 0;
  std::int64_t first_key = 0;
  std::vector<std::int32_t> start;  ///< one more than cells; absolute indices

  /// @pre keys of rows [begin, end) ascend and lie in the slabs
  template <int Dim>
  void index(const Grid<Dim>& grid, const ParticleStore<Dim>& store, Rows rows, int from_slab,
             int to_slab);

  [[nodiscard]] bool has_slab(int slab) const { return slab >= slab_begin && slab < slab_end; }
  [[nodiscard]] Rows cells(std::int64_t key_begin, std::int64_t key_end) const {
    return {start[static_cast<std::size_t>(key_begin - first_key)],
            start[static_cast<std::size_t>(key_end - first_key)]};
  }
  [[nodiscard]] std::int32_t first_row(int slab, std::int64_t slab_size) const {
    return start[static_cast<std::size_t>((slab - slab_begin) * slab_size)];
  }
};

/// The cells around one cell as row ranges in ascending order, taken from `index`, which must not
/// change in between.
/// @param slab_offsets  which neighbouring slabs to look at: {-1,0,1} or one of them
/// @param after_key     only cells with a larger key; -1 for all
template <int Dim>
struct Neighbourhood {
  std::array<Rows, 32> ranges;
  int count = 0;
  bool wraps = false;  ///< some lie around an end of the box

  void collect(const Grid<Dim>& grid, const CellIndex& index, std::int64_t key, int first_offset,
               int last_offset, std::int64_t after_key);

 private:
  /// Cells along the last axis, from `key` on.
  struct Line {
    std::int64_t key = 0;
    bool wraps = false;
  };

  void find_lines(const Grid<Dim>& grid, const CellIndex& index, std::int64_t line,
                  int first_offset, int last_offset);
  void add_line(const Grid<Dim>& grid, const CellIndex& index, const Line& line, int z,
                std::int64_t after_key);
  void add(Rows rows);
  void finish();
  bool sorted_ = true;

  // Cells of one line are asked for one after the other, and have the same lines around them.
  std::array<Line, 9> lines_;
  int num_lines_ = 0;
  std::int64_t line_ = -1;
  const CellIndex* index_ = nullptr;
  bool is_narrow_ = false;  ///< an axis has so few cells that two are beside each other both ways
};

}  // namespace barchan
