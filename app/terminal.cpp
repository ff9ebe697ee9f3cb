#include <barchan/app/terminal.hpp>

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include <barchan/app/readable.hpp>

namespace barchan::app {
namespace {

constexpr int kDefault = 100, kLeast = 20, kMost = 1000;
constexpr std::size_t kAround = 4;  // columns that a table adds to two of its own

/// The first letters of a text, at most so many columns.
std::string cut(const std::string& text, std::size_t columns) {
  std::string kept;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) ++end;
    if (columns-- == 0) break;
    kept.append(text, at, end - at);
    at = end;
  }
  return kept;
}

/// Breaks at spaces, but not between a number and its "%"; a word that is longer than a line stays
/// whole.
std::vector<std::string> lines_of(const std::string& text, std::size_t columns) {
  std::vector<std::string> lines(1);
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = std::min(text.find(' ', at + 1), text.size());
    if (text.compare(end, 2, " %") == 0) end = std::min(text.find(' ', end + 1), text.size());
    const std::string word = text.substr(at, end - at);  // with the space before it
    std::string& line = lines.back();
    if (!line.empty() && width_of(line) + width_of(word) > columns)
      lines.push_back(word.substr(std::min(word.find_first_not_of(' '), word.size())));
    else
      line += word;
    at = end;
  }
  return lines;
}

}  // namespace

int columns_of(int descriptor) {
  if (const char* told = std::getenv("COLUMNS")) {
    if (const int columns = std::atoi(told); columns > 0) return std::clamp(columns, kLeast, kMost);
  }
  winsize size{};
  const bool is_known =
      ::isatty(descriptor) != 0 && ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? std::clamp<int>(size.ws_col, kLeast, kMost) : kDefault;
}

std::string joined_within(const std::vector<std::string>& parts, int columns) {
  const auto room = static_cast<std::size_t>(columns);
  std::string line;
  for (const std::string& part : parts) {
    const std::string longer = line.empty() ? cut(part, room) : line + ", " + part;
    if (width_of(longer) > room) break;
    line = longer;
  }
  return line;
}

std::vector<std::vector<std::string>> wrapped_within(
    const std::vector<std::vector<std::string>>& rows, int columns) {
  std::size_t label = 0;
  for (const auto& row : rows) label = std::max(label, width_of(row[0]));
  const std::size_t taken = label + kAround;
  const auto all = static_cast<std::size_t>(columns);
  const std::size_t room = std::max<std::size_t>(all > taken ? all - taken : 0, kLeast);
  std::vector<std::vector<std::string>> wrapped;
  for (const auto& row : rows) {
    std::string name = row[0];
    for (const std::string& line : lines_of(row[1], room)) {
      wrapped.push_back({name, line});
      name.clear();
    }
  }
  return wrapped;
}

}  // namespace barchan::app
