#include <barchan/app/experiments/axes.hpp>

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/model/digest.hpp>

namespace barchan::app {
namespace {

constexpr std::size_t kLongestName = 200;  // that file systems take is 255 bytes

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("=,.+-_%").find(c) != std::string_view::npos;
}

}  // namespace

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0)
      quote = c == quote ? '\0' : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '[' || c == '{')
      ++depth;
    else if (c == ']' || c == '}')
      --depth;
    if (c == separator && depth <= 0 && quote == 0)
      parts.emplace_back();
    else
      parts.back().push_back(c);
  }
  return parts;
}

std::vector<Point> combinations(const std::vector<Axis>& axes) {
  std::vector<Point> points(1);
  for (const Axis& axis : axes) {
    std::vector<Point> longer;
    for (const Point& point : points) {
      for (const std::string& value : axis.values) {
        longer.push_back(point);
        longer.back().push_back({axis.name, value});
      }
    }
    points = std::move(longer);
  }
  return points;
}

std::string value_of(const Point& point, std::string_view axis) {
  for (const AxisValue& at : point) {
    if (at.axis == axis) return at.value;
  }
  return {};
}

Point parse_point(std::string_view text) {
  Point point;
  for (const std::string& word : split(text, ',')) {
    const auto equals = word.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == word.size())
      throw InputError(fmt::format("'{}' is no value along an axis", word),
                       "give AXIS=VALUE, such as exchange=isend");
    point.push_back({word.substr(0, equals), word.substr(equals + 1)});
  }
  return point;
}

std::string text_of(const Point& point) {
  std::string text;
  for (const AxisValue& at : point) text += (text.empty() ? "" : ",") + at.axis + "=" + at.value;
  return text;
}

std::string folder_name(const Point& point) {
  const std::string text = text_of(point);
  std::string name = text;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !is_plain(c); }, '_');
  if (name == text && name.size() <= kLongestName) return name;
  // Different points have different folders, however their names are shortened.
  return fmt::format("{}-{:016x}", name.substr(0, kLongestName),
                     hash_of_bytes(std::as_bytes(std::span(text))));
}

bool has(const Point& point, const Point& values) {
  return std::all_of(values.begin(), values.end(), [&](const AxisValue& at) {
    return std::find(point.begin(), point.end(), at) != point.end();
  });
}

Point without(const Point& point, const Point& axes) {
  Point rest;
  for (const AxisValue& at : point) {
    const bool is_named = std::any_of(
        axes.begin(), axes.end(), [&](const AxisValue& other) { return other.axis == at.axis; });
    if (!is_named) rest.push_back(at);
  }
  return rest;
}

Point with(const Point& point, const Point& values) {
  Point changed = point;
  for (AxisValue& at : changed) {
    const std::string value = value_of(values, at.axis);
    if (!value.empty()) at.value = value;
  }
  return changed;
}

std::vector<std::string> varied_axes(const std::vector<Point>& points) {
  std::vector<std::string> names;
  for (const Point& point : points) {
    for (const AxisValue& at : point) {
      const bool differs = std::any_of(points.begin(), points.end(), [&](const Point& other) {
        return value_of(other, at.axis) != at.value;
      });
      if (differs && std::find(names.begin(), names.end(), at.axis) == names.end())
        names.push_back(at.axis);
    }
  }
  return names;
}

}  // namespace barchan::app
