#pragma once

#include <string>
#include <string_view>
#include <vector>

// Where runs stand in an experiment.

namespace barchan::app {

struct AxisValue {
  std::string axis, value;
  bool operator==(const AxisValue&) const = default;
};

/// A run's values along the axes of an experiment, in words, such as ranks=2,exchange=isend.
using Point = std::vector<AxisValue>;

struct Axis {
  std::string name;
  std::vector<std::string> values;
};

/// The pieces of a text between separators that stand outside brackets and quotes.
[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator);

/// All combinations, the last axis the fastest.
[[nodiscard]] std::vector<Point> combinations(const std::vector<Axis>& axes);

/// Of a point along an axis; empty where it has none.
[[nodiscard]] std::string value_of(const Point& point, std::string_view axis);

/// "ranks=2,exchange=isend". Errors: InputError for a text without "=" or value.
[[nodiscard]] Point parse_point(std::string_view text);
[[nodiscard]] std::string text_of(const Point& point);
/// The same as the name of a folder.
[[nodiscard]] std::string folder_name(const Point& point);

/// Whether a point has all these values.
[[nodiscard]] bool has(const Point& point, const Point& values);
[[nodiscard]] Point without(const Point& point, const Point& axes);  ///< whatever their values
/// The point with other values along some axes.
[[nodiscard]] Point with(const Point& point, const Point& values);

/// The axes along which some points differ, in the order of the points' own.
[[nodiscard]] std::vector<std::string> varied_axes(const std::vector<Point>& points);

}  // namespace barchan::app
