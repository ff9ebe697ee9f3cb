// Single values: types and ranges as the schema states them.
#include <barchan/core/deck/values.hpp>

#include <cmath>

#include <fmt/format.h>

#include <barchan/core/base/nearest.hpp>
#include <barchan/core/deck/not_modelled.hpp>

namespace barchan::deck {

namespace {

bool is_in_range(ValueType type, double value) {
  switch (type) {
    case ValueType::PositiveNumber:
    case ValueType::PositiveInteger:
    case ValueType::Radius:
      return value > 0.0;
    case ValueType::NonNegativeNumber:
    case ValueType::NonNegativeInteger:
      return value >= 0.0;
    case ValueType::Restitution:
      return value > 0.0 && value <= 1.0;
    case ValueType::Fraction:
      return value >= 0.0 && value <= 1.0;
    case ValueType::PoissonRatio:
      return value > -1.0 && value <= 0.5;
    case ValueType::ProperFraction:
      return value > 0.0 && value < 1.0;
    default:
      return true;
  }
}

std::string in_unit(const KeySpec& spec) {
  return spec.unit.empty() ? std::string() : fmt::format(" in {}", spec.unit);
}

std::string_view one_number(const Node& node) {
  return node.kind == Node::Kind::String ? "it without quotes" : "one number";
}

}  // namespace

void fail_type(const Node& node, std::string_view what, std::string_view expected,
               std::string_view remedy) {
  throw InputError(node.place(),
                   fmt::format("{}: expected {}, found {}", what, expected, kind_name(node.kind)),
                   std::string(remedy));
}

double finite_number(const Node& node, std::string_view what) {
  if (!node.is_number())
    fail_type(node, what, "a number",
              fmt::format("write {}, such as 0.5 or 2e-4", one_number(node)));
  if (!std::isfinite(node.number)) {
    throw InputError(node.place(), fmt::format("{} is not finite: {}", what, node.number),
                     "write a finite number");
  }
  return node.number;
}

Vec3 finite_vector(const Node& node, int dimension, std::string_view what) {
  const std::string_view remedy = dimension == 2 ? "in 2D write [x, y]" : "in 3D write [x, y, z]";
  if (node.kind != Node::Kind::Array) fail_type(node, what, "an array of numbers", remedy);
  if (node.items.size() != static_cast<std::size_t>(dimension)) {
    throw InputError(node.place(),
                     fmt::format("{}: {} numbers, expected {}", what, node.items.size(), dimension),
                     std::string(remedy));
  }
  Vec3 vector = Vec3::Zero();
  for (int axis = 0; axis < dimension; ++axis) vector[axis] = finite_number(node.items[axis], what);
  return vector;
}

double checked_number(const Node& node, const KeySpec& spec) {
  const double value = finite_number(node, spec.key);
  if (!is_in_range(spec.type, value)) {
    throw InputError(node.place(), fmt::format("{} = {} is out of range", spec.key, value),
                     fmt::format("write {} {}{}", type_text(spec).starts_with('i') ? "an" : "a",
                                 type_text(spec), in_unit(spec)));
  }
  return value;
}

std::int64_t whole_number(const Node& node, std::string_view what) {
  constexpr double kExact = 0x1p53;  // up to here every whole number is a double
  if (!node.is_number())
    fail_type(node, what, "an integer",
              fmt::format("write {}, such as 1000 or 1e3", one_number(node)));
  if (node.kind == Node::Kind::Integer) return node.integer;
  const double value = finite_number(node, what);
  if (value != std::floor(value)) {
    throw InputError(node.place(), fmt::format("{} = {} is not a whole number", what, value),
                     "write one, such as 1000 or 1e3");
  }
  if (std::abs(value) > kExact) {
    throw InputError(node.place(), fmt::format("{} = {} is too large", what, value),
                     "with a point or an exponent numbers are exact up to 9007199254740992; write "
                     "all digits of a larger one");
  }
  return static_cast<std::int64_t>(value);
}

std::int64_t checked_integer(const Node& node, const KeySpec& spec) {
  const std::int64_t value = whole_number(node, spec.key);
  (void)checked_number(node, spec);
  return value;
}

std::string checked_string(const Node& node, const KeySpec& spec) {
  if (node.kind != Node::Kind::String)
    fail_type(node, spec.key, "a string", "write it in double quotes");
  if (spec.type == ValueType::Choice) {
    const auto choices = split_choices(spec.choices);
    for (const std::string_view choice : choices) {
      if (node.text == choice) return node.text;
    }
    const auto left_out = find_not_modelled(spec.table, node.text);
    throw InputError(
        node.place(),
        fmt::format("{} = \"{}\" is not one of {}", spec.key, node.text, type_text(spec)),
        left_out ? fmt::format("{} not modelled: {}", left_out->physics, left_out->instead)
                 : suggest(node.text, choices));
  }
  if (node.text.empty()) {
    throw InputError(node.place(), fmt::format("{} is empty", spec.key),
                     "write at least one letter");
  }
  return node.text;
}

}  // namespace barchan::deck
