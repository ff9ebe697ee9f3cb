#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/core/base/error.hpp>

// The tree of a deck's text: every value knows where it stands. Only node.cpp knows the TOML
// library.

namespace barchan::deck {

/// One value of a deck: a table with members, an array with items, or a scalar.
struct Node {
  enum class Kind { Table, Array, String, Integer, Float, Boolean, Date };
  struct Member;

  Kind kind = Kind::Table;
  std::shared_ptr<const std::string> file;
  std::int64_t line = 0;
  std::int64_t column = 0;
  std::string text;          ///< String
  double number = 0.0;       ///< Integer or Float
  std::int64_t integer = 0;  ///< Integer
  bool boolean = false;      ///< Boolean
  std::vector<Member> members;
  std::vector<Node> items;

  [[nodiscard]] SourcePlace place() const;
  [[nodiscard]] bool is_number() const { return kind == Kind::Integer || kind == Kind::Float; }
  [[nodiscard]] const Member* find(std::string_view key) const;
  [[nodiscard]] Member* find(std::string_view key);
};

struct Node::Member {
  std::string key;
  SourcePlace place;  ///< of the key
  Node value;
};

/// "a number", "a string", ... as messages say it.
std::string_view kind_name(Node::Kind kind);

/// Where a key stands, such as `wall.2.normal` (entries count from 1), or else the last table on
/// the way there.
SourcePlace place_of(const Node& root, std::string_view key);

/// Reads TOML text. Errors: InputError with the place where the text stops being TOML.
Node parse_toml(std::string_view text, const std::string& file_name);

}  // namespace barchan::deck
