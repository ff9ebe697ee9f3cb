#include <barchan/core/deck/read_sizes.hpp>

#include <numbers>

#include <fmt/format.h>

#include <barchan/core/deck/values.hpp>

namespace barchan::deck {

namespace {

constexpr const char* kRemedy =
    "write one radius, [min, max], or [{ radius = ..., weight = ... }, ...]";

double read_radius(const Node& node) {
  static const KeySpec& spec = *find_key("hole", "radius");  // a number > 0 in m
  return checked_number(node, spec);
}

RadiusClass read_class(const Node& node, int dimension) {
  if (node.kind == Node::Kind::Table && !node.find("radius"))
    throw InputError(node.place(), "radius: a size class without a radius", kRemedy);
  const TableReader table(node, dimension, "size class");
  const double radius = table.number("radius");
  return {radius, radius, table.number("weight")};
}

RadiusClass read_range(const Node& node) {
  if (node.items.size() != 2) {
    throw InputError(node.place(), fmt::format("radius: an array of {} numbers", node.items.size()),
                     kRemedy);
  }
  const RadiusClass range{read_radius(node.items[0]), read_radius(node.items[1]), 1.0};
  if (range.max < range.min) {
    throw InputError(node.place(),
                     fmt::format("radius: the range {} to {} is empty", range.min, range.max),
                     "write the smaller radius first");
  }
  return range;
}

}  // namespace

SizeDistribution read_sizes(const TableReader& table) {
  const Node& node = *table.value("radius");
  if (node.kind == Node::Kind::Table || node.kind == Node::Kind::String)
    fail_type(node, "radius", "a number or an array", kRemedy);
  if (node.kind != Node::Kind::Array) {
    const double radius = read_radius(node);
    return {{{radius, radius, 1.0}}};
  }
  const bool has_classes = !node.items.empty() && node.items.front().kind == Node::Kind::Table;
  if (!has_classes) return {{read_range(node)}};
  SizeDistribution sizes;
  for (const Node& item : node.items) sizes.classes.push_back(read_class(item, table.dimension()));
  return sizes;
}

double mean_measure(const SizeDistribution& sizes, int dimension) {
  double total = 0.0;
  double weights = 0.0;
  for (const RadiusClass& size : sizes.classes) {
    const double a = size.min;
    const double b = size.max;
    const double mean = dimension == 2
                            ? std::numbers::pi * (a * a + a * b + b * b) / 3.0
                            : 4.0 / 3.0 * std::numbers::pi * (a + b) * (a * a + b * b) / 4.0;
    total += size.weight * mean;
    weights += size.weight;
  }
  return total / weights;
}

}  // namespace barchan::deck
