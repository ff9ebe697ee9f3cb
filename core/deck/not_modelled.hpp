#pragma once

#include <optional>
#include <string_view>

namespace barchan::deck {

/// Physics that decks of other codes name and barchan leaves out (docs/limits.md).
struct NotModelled {
  std::string_view physics;  ///< with its verb: "heat is"
  std::string_view instead;
};

/// What a key or a choice of a table means, by its words: `rolling_friction`, `RollingFriction` and
/// `rolling_resistance` are one. None for a word that names no such thing.
std::optional<NotModelled> find_not_modelled(std::string_view table, std::string_view word);

}  // namespace barchan::deck
