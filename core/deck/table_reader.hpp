#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/core/base/vec.hpp>
#include <barchan/core/deck/node.hpp>
#include <barchan/core/deck/schema.hpp>

namespace barchan::deck {

/// Reads one table of a deck by its schema: types, ranges, defaults and "required" come from there.
/// Every failure is an InputError with the place of the key or value, and a remedy.
class TableReader {
 public:
  /// Refuses unknown keys at once. `more` names a second schema table whose keys may stand here
  /// too.
  TableReader(const Node& node, int dimension, std::string_view table, std::string_view more = {});

  [[nodiscard]] double number(std::string_view key) const;
  [[nodiscard]] std::optional<double> optional_number(std::string_view key) const;
  [[nodiscard]] std::int64_t integer(std::string_view key) const;
  [[nodiscard]] std::optional<std::int64_t> optional_integer(std::string_view key) const;
  [[nodiscard]] bool boolean(std::string_view key) const;
  [[nodiscard]] std::string string(std::string_view key) const;  ///< a String or Choice
  [[nodiscard]] std::optional<std::string> optional_string(std::string_view key) const;
  [[nodiscard]] Vec3 vector(std::string_view key) const;
  [[nodiscard]] Vec3 spin(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> names(std::string_view key) const;
  [[nodiscard]] std::vector<const Node*> tables(std::string_view key) const;
  [[nodiscard]] const Node* table(std::string_view key) const;

  /// The value of a key whatever its type, none when absent and not required.
  [[nodiscard]] const Node* value(std::string_view key) const;
  [[nodiscard]] bool has(std::string_view key) const { return value(key) != nullptr; }

  [[nodiscard]] SourcePlace place() const { return node_.place(); }
  [[nodiscard]] SourcePlace place(
      std::string_view key) const;  ///< of the value, or of the table without it
  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] std::string_view name() const { return table_; }  ///< as the schema has it

  /// Refuses a second key where only one of two may stand; false when neither does.
  bool has_one_of(std::string_view first, std::string_view second) const;

  [[noreturn]] void fail(std::string_view key, const std::string& what,
                         const std::string& remedy) const;

 private:
  [[nodiscard]] const KeySpec& spec(std::string_view key) const;
  void refuse_unknown(const Node::Member& member) const;
  [[noreturn]] void fail_missing(const KeySpec& spec) const;

  const Node& node_;
  int dimension_;
  std::string_view table_;
  std::string_view more_;
};

}  // namespace barchan::deck
