#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <barchan/app/command_line.hpp>

// What the options of several commands share.

namespace barchan::app {

[[nodiscard]] std::string listed(const std::vector<std::string>& words);  ///< "a, b, c"

/// One of some words, else the nearest of them is named.
[[nodiscard]] CLI::Validator one_of(const std::vector<std::string>& words);

/// An empty argument is often a variable of a script that was never set: what an option is for must
/// not be left to its default then.
[[nodiscard]] CLI::Validator not_empty();

/// Turns 1e3 into 1000, and refuses what is no whole number in these words.
[[nodiscard]] CLI::Validator whole_number();

void add_settings(CLI::App& command, std::vector<std::string>& settings);

/// The commands that start runs, compare them and show them.
void add_experiments(CLI::App& root, CommandLine& line);

/// The commands that print what other programs read about this one.
struct TextWords {
  std::string shell, page, pages;
};
void add_texts(CLI::App& root, TextWords& words);
/// What they print. Errors: InputError, RunError.
[[nodiscard]] std::string text_of(const CLI::App& root, const TextWords& words);

/// First and last step of "1000:1010"; empty: it is no such text.
[[nodiscard]] std::optional<std::pair<std::int64_t, std::int64_t>> step_window(
    const std::string& text);

}  // namespace barchan::app
