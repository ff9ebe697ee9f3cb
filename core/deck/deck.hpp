#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/core/model/model.hpp>
#include <barchan/core/model/particle_source.hpp>

// Decks: TOML in, checked plain data out. docs/deck.md is the reference; schema.hpp lists every
// key.

namespace barchan {

/// One `--set key=value`. `key` is dotted; an entry of an array of tables is named by its `name` or
/// by its number from 1: `time.step`, `material.soil.friction`, `particles.1.count`. `value` is
/// TOML; what is not TOML is taken as a string, so words need no quotes.
struct DeckOverride {
  std::string key;
  std::string value;
};

/// Takes `key=value` apart. Errors: InputError without `=` or without a key.
DeckOverride parse_override(std::string_view argument);

struct Deck {
  Model model;
  std::vector<ParticleSource> sources;  ///< in deck order
  std::vector<SourceKey> keys;          ///< all that it says, overrides included; at most 101
};

/// Reads and checks a deck; a source's relative path is taken from the deck's folder.
/// Errors: InputError with file, line and column, what is wrong, what would be right.
Deck read_deck(const std::string& path, std::span<const DeckOverride> overrides = {});

/// The same from text; `file_name` is what errors say. Touches no file: particle files are not
/// opened here.
Deck parse_deck(std::string_view text, const std::string& file_name,
                std::span<const DeckOverride> overrides = {});

}  // namespace barchan
