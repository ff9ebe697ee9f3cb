#include <barchan/core/io/csv_table.hpp>

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

constexpr std::size_t kMaxFields = 1000;
constexpr std::string_view kSeparators = ",;\t";

/// Which of the usual separators a header has most of, outside of quotes; NUL: none.
char separator_of(std::string_view header) {
  std::size_t most = 0;
  char best = '\0';
  for (const char candidate : kSeparators) {
    bool is_quoted = false;
    std::size_t count = 0;
    for (const char c : header) {
      if (c == '"') is_quoted = !is_quoted;
      if (c == candidate && !is_quoted) ++count;
    }
    if (count > most) best = candidate;
    most = std::max(most, count);
  }
  return best;
}

/// The separator of a line such as `sep=;`, which spreadsheets write before the header; NUL: it is
/// none.
char announced_separator(std::string_view line) {
  constexpr std::string_view kStart = "sep=";
  if (line.size() >= 2 && line.front() == '"' && line.back() == '"')
    line = line.substr(1, line.size() - 2);
  if (line.size() != kStart.size() + 1) return '\0';
  for (std::size_t i = 0; i < kStart.size(); ++i) {
    if (std::tolower(static_cast<unsigned char>(line[i])) != kStart[i]) return '\0';
  }
  return line.back();
}

}  // namespace

CsvTable::CsvTable(std::string_view text, std::string_view file) : lines_(text, file) {
  std::string_view line;
  if (!next_line(line)) return;
  if (const char announced = announced_separator(line); announced != '\0') {
    separator_ = announced;
    if (!next_line(line)) return;
  }
  if (separator_ == '\0') take_separator(trimmed(line));
  split(line);
  header_.assign(fields_.begin(), fields_.end());
}

void CsvTable::take_separator(std::string_view line) {
  separator_ = separator_of(line);
  if (separator_ != '\0') return;
  for (const auto& [mark, name] : {std::pair{'|', "bars"}, std::pair{' ', "blanks"}}) {
    if (line.front() == '"' || line.find(mark) == std::string_view::npos) continue;
    throw InputError(lines_.place(line), fmt::format("the columns are separated by {}", name),
                     "separate them by commas, semicolons or tabs");
  }
  separator_ = ',';
}

bool CsvTable::next_line(std::string_view& line) {
  while (lines_.next(line)) {
    const std::string_view content = trimmed(line);
    if (!content.empty() && content.front() != '#') return true;
  }
  return false;
}

bool CsvTable::next() {
  std::string_view line;
  if (header_.empty() || !next_line(line)) return false;
  split(line);
  if (fields_.size() != header_.size()) wrong_count();
  return true;
}

void CsvTable::wrong_count() const {
  const bool is_comma = separator_ == ',' && fields_.size() > header_.size();
  throw InputError(lines_.place(), fmt::format("{} fields", fields_.size()),
                   fmt::format("the header has {} columns{}", header_.size(),
                               is_comma ? "; numbers take a decimal point" : ""));
}

/// Takes fields until the line is over; blanks around them are no part of them, tabs only where
/// tabs do not separate.
void CsvTable::split(std::string_view line) {
  const std::string_view blanks = separator_ == '\t' ? " \r" : " \t\r\f\v";
  fields_.clear();
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    const bool is_quoted = line.starts_with('"');
    const std::string_view quoted = is_quoted ? take_quoted(line) : line;
    const std::size_t end = std::min(line.find(separator_), line.size());
    const std::string_view part = line.substr(0, end);
    const std::string_view rest = part.substr(0, part.find_last_not_of(blanks) + 1);
    if (is_quoted && !rest.empty())
      throw InputError(lines_.place(rest), in_quotes(rest) + " follows a closing quote",
                       "a separator belongs there");
    fields_.push_back(is_quoted ? trimmed(quoted) : rest);
    if (fields_.size() > kMaxFields)
      throw InputError(lines_.place(), "more than 1000 columns", "is this a particle table?");
    if (end == line.size()) return;
    line.remove_prefix(end + 1);
  }
}

/// What stands in quotes at the beginning of `rest`, which then begins behind them; a doubled quote
/// is part of it.
std::string_view CsvTable::take_quoted(std::string_view& rest) const {
  std::size_t end = rest.find('"', 1);
  while (end != std::string_view::npos && rest.substr(end + 1).starts_with('"'))
    end = rest.find('"', end + 2);
  if (end == std::string_view::npos)
    throw InputError(lines_.place(rest), "a quote is not closed in its line",
                     "close it, and keep every row on one line");
  const std::string_view quoted = rest.substr(1, end - 1);
  rest.remove_prefix(end + 1);
  return quoted;
}

}  // namespace barchan
