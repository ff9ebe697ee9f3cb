#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <barchan/core/io/series.hpp>
#include <barchan/tasks/results/rings.hpp>
#include <barchan/tasks/simulation.hpp>

namespace barchan {

/// series.csv of a run: energies, momentum, bonds, wall forces and ring diameters;
/// docs/run_folder.md has the columns.
class SeriesTable {
 public:
  /// Starts the file on rank 0. Collective. Errors: RunError.
  /// @param continues  keeps the rows before the present step. Errors: InputError: a damaged row
  SeriesTable(const Simulation& simulation, const std::string& path, std::vector<Ring> rings,
              bool continues = false);

  /// Words of warning where rows before a restart are not as a run leaves them; empty elsewhere. On
  /// rank 0; local.
  /// @param interval  steps between rows from here on
  [[nodiscard]] std::string damage(const Simulation& simulation, std::int64_t interval) const;

  /// A row of the present state. Collective. @return what was measured. Errors: RunError.
  Measures append(Simulation& simulation);

 private:
  std::vector<Ring> rings_;
  std::optional<SeriesWriter> writer_;  ///< rank 0
};

/// A name as part of a column's name: all but letters, digits, - and _ becomes _.
[[nodiscard]] std::string column_name(const std::string& name);

/// What the columns of each wall begin with: its column_name, and where two walls would get the
/// same, _2, _3, ... behind it. A wall whose name needs no change keeps it.
[[nodiscard]] std::vector<std::string> wall_columns(std::span<const WallSpec> walls);

}  // namespace barchan
