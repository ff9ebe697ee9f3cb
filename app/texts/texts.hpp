#pragma once

#include <string>
#include <vector>

// What other programs read about the command; all follows from the definition of the command line.

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace barchan::app {

/// The words that an option takes, where they are few; empty otherwise.
[[nodiscard]] std::vector<std::string> choices_of(const CLI::Option& option);

/// Whether an option takes a word after it.
[[nodiscard]] bool takes_word(const CLI::Option& option);

/// Shell completion. @param shell  bash, zsh or fish
[[nodiscard]] std::string completion_for(const CLI::App& root, const std::string& shell);

/// A manual page in roff, of the whole command or of one of its commands.
/// @param name  empty: the whole one. @param version  as in "barchan 1.0"
[[nodiscard]] std::string man_page(const CLI::App& root, const std::string& name,
                                   const std::string& version);

/// The deck as a JSON Schema, for editors, from the tables of keys.
[[nodiscard]] std::string deck_schema();

}  // namespace barchan::app
