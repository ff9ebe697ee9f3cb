#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include <barchan/core/deck/deck.hpp>

// Deck texts for tests: a small deck that is right, and ways to spoil it.

namespace barchan::deck_test {

using Edit = std::pair<std::string, std::string>;

/// A 2D deck with two materials, a bond, a wall, a stage and two sources. Its lines keep their
/// numbers.
inline std::string good_deck() {
  return R"(dimension = 2
gravity = [0.0, -9.81]
[domain]
lo = [0.0, 0.0]
hi = [10.0, 5.0]
[time]
step = 1e-4
end = 2.0
[[material]]
name = "soil"
density = 126.0
normal_stiffness = 55000.0
friction = 0.5
[[material]]
name = "duct"
density = 250.0
normal_stiffness = 65000.0
friction = 0.6
[[bond]]
name = "pipe"
young_modulus = 1e6
[[wall]]
name = "floor"
point = [0.0, 0.0]
normal = [0.0, 2.0]
material = "soil"
[[stage]]
name = "settle"
max_time = 1.0
[[particles]]
kind = "packing"
region = { lo = [0.0, 0.0], hi = [10.0, 3.0] }
radius = [0.04, 0.06]
count = 1000
holes = [{ center = [5.0, 1.5], radius = 0.6 }]
material = "soil"
[[particles]]
kind = "ring"
center = [5.0, 1.5]
radius = 0.45
count = 24
material = "duct"
bond = "pipe"
)";
}

/// `text` with the first occurrence of each edit's left side replaced by its right side.
inline std::string edited(std::string text, std::initializer_list<Edit> edits) {
  for (const auto& [from, to] : edits) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("the test deck has no " + from);
    text.replace(at, from.size(), to);
  }
  return text;
}

inline Deck parse_edited(std::initializer_list<Edit> edits) {
  return parse_deck(edited(good_deck(), edits), "test.toml");
}

/// What the deck's error says; empty when it is accepted.
inline std::string error_of(const std::string& text) {
  try {
    (void)parse_deck(text, "test.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

inline std::string error_of(std::initializer_list<Edit> edits) {
  return error_of(edited(good_deck(), edits));
}

}  // namespace barchan::deck_test
