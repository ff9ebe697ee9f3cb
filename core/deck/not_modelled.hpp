#pragma once

#include <optional>
#include <string_view>

namespace barchan::deck {

/// Physics that decks of other codes name and barchan leaves out (docs/limits.md).
struct NotModelled {
  std::string_view physics;  ///< with its verb: "heat is"
  std::string_view instead;
};

/// None for a key that names no such thing.
std::optional<NotModelled> find_not_modelled(std::string_view key);

}  // namespace barchan::deck
