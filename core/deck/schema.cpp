#include <barchan/core/deck/schema.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/deck/schema_keys.hpp>

namespace barchan {

namespace deck {

std::span<const KeySpec> key_specs() {
  static const std::vector<KeySpec> all = [] {
    std::vector<KeySpec> keys;
    for (const auto part : {run_keys(), physics_keys(), law_keys(), particle_keys()}) {
      keys.insert(keys.end(), part.begin(), part.end());
    }
    return keys;
  }();
  return all;
}

const KeySpec* find_key(std::string_view table, std::string_view key) {
  for (const KeySpec& spec : key_specs()) {
    if (spec.table == table && spec.key == key) return &spec;
  }
  return nullptr;
}

std::string type_text(const KeySpec& spec) {
  switch (spec.type) {
    case ValueType::Number:
      return "number";
    case ValueType::PositiveNumber:
      return "number > 0";
    case ValueType::NonNegativeNumber:
      return "number >= 0";
    case ValueType::Restitution:
      return "number in (0, 1]";
    case ValueType::Fraction:
      return "number in [0, 1]";
    case ValueType::PoissonRatio:
      return "number in (-1, 0.5]";
    case ValueType::ProperFraction:
      return "number in (0, 1)";
    case ValueType::Integer:
      return "integer";
    case ValueType::PositiveInteger:
      return "integer > 0";
    case ValueType::NonNegativeInteger:
      return "integer >= 0";
    case ValueType::Boolean:
      return "boolean";
    case ValueType::String:
      return "string";
    case ValueType::Choice:
      return fmt::format("{}", fmt::join(split_choices(spec.choices), ", "));
    case ValueType::Vector:
      return "vector";
    case ValueType::Spin:
      return "2D number, 3D vector";
    case ValueType::Names:
      return "array of strings";
    case ValueType::Radius:
      return "number > 0, [min, max] or size classes";
    case ValueType::Fixed:
      return "boolean or box";
    case ValueType::Pairs:
      return "array of [id, id]";
    case ValueType::Cuts:
      return "auto, strips or integers";
    case ValueType::Table:
      return "table";
    case ValueType::Tables:
      return "array of tables";
  }
  return {};
}

std::vector<std::string_view> split_choices(std::string_view choices) {
  std::vector<std::string_view> words;
  while (!choices.empty()) {
    const std::size_t bar = std::min(choices.find('|'), choices.size());
    words.push_back(choices.substr(0, bar));
    choices.remove_prefix(std::min(bar + 1, choices.size()));
  }
  return words;
}

}  // namespace deck

std::vector<KeyDoc> deck_keys() {
  std::vector<KeyDoc> docs;
  for (const deck::KeySpec& spec : deck::key_specs()) {
    docs.push_back({std::string(spec.table), std::string(spec.key), deck::type_text(spec),
                    std::string(spec.unit), std::string(spec.default_value),
                    std::string(spec.meaning)});
  }
  return docs;
}

}  // namespace barchan
