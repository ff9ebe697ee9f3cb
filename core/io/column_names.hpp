#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/core/io/text_file.hpp>

// Names of columns in the forms that other programs write: `Vx`, `v_x`, `velocity:0`,
// `velocity[0]`, `Velocity.X`, `Particle Identifier`.

namespace barchan {

/// What a name may be called, in lower-case letters and digits alone: all else in a header's names
/// is left out before they are compared. One number may have several names.
struct ColumnAlias {
  std::string name;
  int column = 0;
  int alternative = -1;  ///< a column that makes this one needless, if any
};

/// Names of the three components of a vector: `base` with x, y, z, or with 0, 1, 2 (where the base
/// is not empty), for columns first, first + 1, first + 2.
void add_vector_names(std::vector<ColumnAlias>& aliases, std::string_view base, int first);

/// What each column of a header is.
struct ColumnMap {
  static constexpr int kUnused = -1;
  std::vector<int> columns;         ///< a number of ColumnAlias, or kUnused
  std::vector<std::string> unused;  ///< names of columns that nothing is known by

  [[nodiscard]] bool has(int column) const;
  /// Takes a column for one that is not used.
  void drop(int column, std::span<const std::string> header);
  /// "columns not used: 'rank', 'mass'"; empty where all are.
  [[nodiscard]] std::string note() const;
};

/// @param names  of the columns as messages call them, by their number
/// @throws InputError: a column given twice; a name that comes close to that of a column that is
/// given nowhere, or has a unit behind it; components that do not count from 0
[[nodiscard]] ColumnMap map_columns(std::span<const std::string> header,
                                    std::span<const ColumnAlias> aliases,
                                    std::span<const std::string_view> names,
                                    const LineReader& lines);

}  // namespace barchan
