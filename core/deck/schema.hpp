#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

// Every key that a deck may hold, once: the parser refuses what is not here, and docs/deck.md is
// held against it.

namespace barchan {

/// One row of the deck reference.
struct KeyDoc {
  /// As the reference heads it: `deck` for the top level, `[time]`, `[[wall]]`, ...
  std::string table;
  std::string key;
  std::string type;
  std::string unit;           ///< empty for none
  std::string default_value;  ///< "required", "none", a value, or how it follows from other keys
  std::string meaning;
};

/// The whole deck reference, in the order in which it is documented.
std::vector<KeyDoc> deck_keys();

namespace deck {

enum class ValueType {
  Number,
  PositiveNumber,
  NonNegativeNumber,
  Restitution,     ///< (0, 1]
  Fraction,        ///< [0, 1]
  PoissonRatio,    ///< (-1, 0.5]
  ProperFraction,  ///< (0, 1)
  Integer,
  PositiveInteger,
  NonNegativeInteger,
  Boolean,
  String,
  Choice,  ///< one of the words in KeySpec::choices
  Vector,  ///< as many numbers as the deck has dimensions
  Spin,    ///< 2D a number, 3D three
  Names,   ///< array of strings
  Radius,  ///< number, [min, max] or array of size classes
  Fixed,   ///< boolean or box
  Pairs,   ///< array of [id, id]
  Cuts,    ///< a word, or as many integers as the deck has dimensions
  Table,
  Tables
};

struct KeySpec {
  std::string_view table;
  std::string_view key;
  ValueType type;
  std::string_view unit;
  std::string_view default_value;
  std::string_view meaning;
  std::string_view choices = {};  ///< separated by '|'
};

/// All keys, table by table.
std::span<const KeySpec> key_specs();

/// The entry, or none when the table has no such key.
const KeySpec* find_key(std::string_view table, std::string_view key);

/// "number > 0", "array of strings", ...: what the reference and the messages call it.
std::string type_text(const KeySpec& spec);

/// The words of a Choice.
std::vector<std::string_view> split_choices(std::string_view choices);

}  // namespace deck
}  // namespace barchan
