#include <barchan/core/deck/key_depth.hpp>

#include <algorithm>
#include <cstddef>

#include <barchan/core/error.hpp>

namespace barchan::deck {

namespace {

constexpr int kMaxDots = 15;

/// Position after the string that opens at `begin`; the end of the line or text when it never
/// closes.
std::size_t skip_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string triple(3, quote);
  if (text.substr(begin, 3) == triple) {
    std::size_t end = begin + 3;
    while (end < text.size() && text.substr(end, 3) != triple) {
      end += (quote == '"' && text[end] == '\\') ? 2 : 1;
    }
    end += 3;
    while (end < text.size() && text[end] == quote)
      ++end;  // a string may end in one or two quotes more
    return std::min(end, text.size());
  }
  std::size_t end = begin + 1;
  while (end < text.size() && text[end] != quote && text[end] != '\n') {
    end += (quote == '"' && text[end] == '\\') ? 2 : 1;
  }
  const bool is_closed = end < text.size() && text[end] == quote;
  return std::min(is_closed ? end + 1 : end, text.size());
}

}  // namespace

void check_key_depth(std::string_view text, const std::string& file_name) {
  int dots = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = skip_string(text, at);
      continue;
    }
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    if (c == '.' && ++dots > kMaxDots) {
      const auto line =
          1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      throw InputError({file_name, line, 0}, "a dotted key of more than 16 parts",
                       "no key of a deck has more than 3");
    }
    if (c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}' || c == '\n') dots = 0;
    ++at;
  }
}

}  // namespace barchan::deck
