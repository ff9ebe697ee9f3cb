#include <barchan/app/options.hpp>

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include <barchan/core/base/nearest.hpp>

namespace barchan::app {

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  return CLI::Validator(
      [words](std::string& word) -> std::string {
        const std::vector<std::string_view> views(words.begin(), words.end());
        for (const auto& known : views) {
          if (known == word) return {};
        }
        return fmt::format("there is no '{}' ({})", word, deck::suggest(word, views));
      },
      "{" + listed(words) + "}");
}

CLI::Validator not_empty() {
  return CLI::Validator(
      [](std::string& word) -> std::string { return word.empty() ? "is empty" : ""; }, "");
}

CLI::Validator whole_number() {
  return CLI::Validator(
      [](std::string& word) -> std::string {
        double value = 0.0;
        const char* end = word.data() + word.size();
        const auto read = std::from_chars(word.data(), end, value);
        if (read.ec != std::errc() || read.ptr != end || value != std::floor(value))
          return "'" + word + "' is not a whole number";
        if (std::abs(value) > 0x1p53) return word + " is too large";
        word = fmt::format("{:.0f}", value);
        return {};
      },
      "");
}

void add_settings(CLI::App& command, std::vector<std::string>& settings) {
  command
      .add_option("--set", settings,
                  "Change the deck, such as time.step=1e-4 or material.soil.friction=0.4")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->allow_extra_args(false);
}

std::optional<std::pair<std::int64_t, std::int64_t>> step_window(const std::string& text) {
  std::pair<std::int64_t, std::int64_t> window;
  const auto colon = text.find(':');
  const auto is_number = [](const std::string& word, std::int64_t& value) {
    const auto read = std::from_chars(word.data(), word.data() + word.size(), value);
    return read.ec == std::errc() && read.ptr == word.data() + word.size() && !word.empty();
  };
  const bool is_window =
      colon != std::string::npos && is_number(text.substr(0, colon), window.first) &&
      is_number(text.substr(colon + 1), window.second) && window.first <= window.second;
  if (!is_window) return std::nullopt;
  return window;
}

}  // namespace barchan::app
