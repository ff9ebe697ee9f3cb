#pragma once

#include <string>
#include <vector>

#include <barchan/app/experiments/measurements.hpp>
#include <barchan/app/json_text.hpp>

namespace barchan::app {

/// The runs of a point in numbers: medians over its repetitions.
struct PointRow {
  Point point;
  std::vector<const Measurement*> runs;
  double step = 0.0, spread = 0.0;  ///< [µs]; largest less smallest over the median
  double ratio = 0.0;  ///< to the base, within repetitions where both have them; 0: none
  double in_flight = 0.0, exposed = 0.0, work = 0.0;  ///< [µs a step]
  double hidden = 0.0;                                ///< share
  double others = 0.0;                                ///< cores, the most of the repetitions
};

/// An experiment as a table. Refers to the experiment.
struct RunTable {
  std::vector<std::string> axes;  ///< along which points differ
  Point common;                   ///< what all points share
  Point base;                     ///< what the first row's ratio is to
  std::vector<PointRow> rows;
  std::vector<std::string>
      digests;  ///< a line for each state in which runs of one deck ended apart
};

/// @param against  "axis=value,...": ratios are to the point that has these and is equal otherwise;
/// empty: to the first point. Errors: InputError where no point has them.
[[nodiscard]] RunTable tabulate(const Experiment& experiment, const std::string& against);

/// The base's values along the axes; empty where the table has one point.
[[nodiscard]] Point shown_base(const RunTable& table);

/// Rows of cells with a head: the axes, then numbers as people read them.
[[nodiscard]] std::vector<std::vector<std::string>> cells_of(const RunTable& table);

/// A time as people read it: four digits, and all of whole microseconds.
[[nodiscard]] std::string microseconds(double time);

/// The numbers of a run.
[[nodiscard]] Json json_of(const Measurement& run);
[[nodiscard]] Json json_of(const RunTable& table);

}  // namespace barchan::app
