#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace barchan::deck {

/// Letters to change, add, drop, or swap with the next one, to make one word from the other.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate that needs the fewest letters changed, added, dropped or swapped; empty when none
/// comes close.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

/// Remedy for an unknown word: "did you mean 'x'?", else the list of what exists.
std::string suggest(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace barchan::deck
