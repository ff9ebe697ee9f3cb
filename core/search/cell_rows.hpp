#pragma once

#include <cstdint>
#include <vector>

#include <barchan/core/base/rows.hpp>

namespace barchan {

/// Whether cells are so many that only those with rows should be kept: an array of all costs less
/// time up to here, and no more memory than the rest of a particle.
[[nodiscard]] constexpr bool is_mostly_empty(std::int64_t num_cells, std::int64_t num_rows) {
  return num_cells > 8 * num_rows + 4096;
}

/// The rows of cells by the number of the cell: an array, or where most cells are empty a hash
/// table of those that are not.
class CellRows {
 public:
  /// No rows yet.
  /// @param num_rows  about as many will come
  void begin(std::int64_t num_cells, std::int64_t num_rows);

  /// Of a cell that has none: {0, 0}.
  [[nodiscard]] Rows of(std::int64_t cell) const {
    if (!is_table_) return rows_[static_cast<std::size_t>(cell)];
    for (std::size_t at = home(cell);; at = (at + 1) & (table_.size() - 1)) {
      if (table_[at].cell == cell) return table_[at].rows;
      if (table_[at].cell < 0) return {0, 0};
    }
  }
  /// To be set before the next call.
  [[nodiscard]] Rows& make(std::int64_t cell);

  [[nodiscard]] std::size_t bytes() const {
    return rows_.capacity() * sizeof(Rows) + table_.capacity() * sizeof(Entry);
  }

 private:
  struct Entry {
    std::int64_t cell = -1;
    Rows rows{0, 0};
  };
  /// Cells of a line lie by fours in a line of cache.
  [[nodiscard]] std::size_t home(std::int64_t cell) const {
    const auto line = static_cast<std::uint64_t>(cell) >> 2;
    return static_cast<std::size_t>((line * 0x9E3779B97F4A7C15) >> shift_) << 2 |
           (static_cast<std::size_t>(cell) & 3);
  }
  void resize_table(std::int64_t num_cells);

  bool is_table_ = false;
  std::vector<Rows> rows_;
  std::vector<Entry> table_;  ///< a power of two, half of it free
  int shift_ = 0;
  std::size_t num_used_ = 0;
};

}  // namespace barchan
