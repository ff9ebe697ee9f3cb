#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace barchan {

/// What every row of a series begins with.
struct SeriesRow {
  std::int64_t step = 0;
  double time = 0.0;            ///< [s]
  double kinetic_energy = 0.0;  ///< [J]
  std::int64_t contacts = 0;
  double max_overlap = 0.0;  ///< [m]
};

/// The rows of a series up to and including `step`, with the header, which must be `header`. A last
/// row without line feed is not trusted. @throws InputError with line: other columns, a damaged row
[[nodiscard]] std::string kept_rows(std::string_view text, const std::string& path,
                                    const std::string& header, std::int64_t step);

/// What is odd about the rows of a series up to a restart, in words; empty where nothing is. Rows
/// must be as long as the header, ascend, and leave no gap wider than those beside it.
/// @param interval  steps between rows from here on
[[nodiscard]] std::string damage_of_rows(std::string_view kept, std::int64_t restart,
                                         std::int64_t interval);

/// The table of a run over time: `step,time,kinetic_energy,contacts,max_overlap`, then columns of
/// the caller. Each row is on its way to the disk before append() returns. One writer per file
/// (rank 0).
class SeriesWriter {
 public:
  /// Starts a new table. @throws RunError when the file cannot be written
  static SeriesWriter create(const std::string& path, std::span<const std::string> further_columns);

  /// Goes on with an existing table after a restart at `step`: rows with a greater step and an
  /// unfinished last row are removed; without a file, starts a new one. A table with other columns
  /// is kept as `series_1.csv` (or the next number that is free), and a new one begins.
  /// @throws InputError for a damaged row; RunError
  static SeriesWriter resume(const std::string& path, std::span<const std::string> further_columns,
                             std::int64_t step);

  ~SeriesWriter();
  SeriesWriter(SeriesWriter&& other) noexcept;
  SeriesWriter& operator=(SeriesWriter&&) = delete;

  /// What was odd about the rows that were kept, or where they are now, with the file's name; empty
  /// where nothing was.
  [[nodiscard]] std::string damage(std::int64_t restart, std::int64_t interval) const;

  /// @param further  one value for each further column; none leaves its cell empty
  /// @throws RunError also when somebody else removed or changed the file meanwhile
  void append(const SeriesRow& row, std::span<const std::optional<double>> further);

 private:
  SeriesWriter(std::string path, std::size_t num_further, const char* mode);
  void put(const std::string& text);

  std::string path_, former_;  ///< former: where rows with other columns are kept; may be empty
  std::size_t num_further_ = 0;
  std::FILE* file_ = nullptr;
  std::int64_t size_ = 0;  ///< [B], so far
};

}  // namespace barchan
