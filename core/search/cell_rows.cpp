#include <barchan/core/search/cell_rows.hpp>

#include <algorithm>
#include <bit>

namespace barchan {

void CellRows::begin(std::int64_t num_cells, std::int64_t num_rows) {
  is_table_ = is_mostly_empty(num_cells, num_rows);
  if (!is_table_) {
    rows_.assign(static_cast<std::size_t>(num_cells), Rows{0, 0});
    table_ = {};
    return;
  }
  rows_ = {};
  resize_table(num_rows);
}

void CellRows::resize_table(std::int64_t num_cells) {
  const auto size =
      std::bit_ceil(static_cast<std::uint64_t>(std::max<std::int64_t>(num_cells, 8))) * 2;
  table_.assign(size, Entry{});
  shift_ = 64 - std::countr_zero(size) + 2;
  num_used_ = 0;
}

Rows& CellRows::make(std::int64_t cell) {
  if (!is_table_) return rows_[static_cast<std::size_t>(cell)];
  if (2 * (num_used_ + 1) > table_.size()) {
    const std::vector<Entry> old = std::move(table_);
    resize_table(static_cast<std::int64_t>(old.size()));
    for (const Entry& entry : old) {
      if (entry.cell >= 0) make(entry.cell) = entry.rows;
    }
  }
  std::size_t at = home(cell);
  while (table_[at].cell >= 0 && table_[at].cell != cell) at = (at + 1) & (table_.size() - 1);
  if (table_[at].cell < 0) ++num_used_;
  table_[at].cell = cell;
  return table_[at].rows;
}

}  // namespace barchan
