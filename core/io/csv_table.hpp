#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/core/io/text_file.hpp>

namespace barchan {

/// A table with a header: fields between commas, semicolons or tabs, whichever the header has most
/// of, or what a first line such as `sep=;` says. Fields may stand in double quotes. Blank lines
/// and lines that begin with # are passed over.
class CsvTable {
 public:
  /// Reads the header, which is empty in a text without any. @param text  see PlainText
  /// @throws InputError with line and column: see next(), and a header cut at blanks
  CsvTable(std::string_view text, std::string_view file);

  [[nodiscard]] const std::vector<std::string>& header() const { return header_; }

  /// The next row; false at the end.
  /// @throws InputError: more or fewer fields than columns, a quote that is not closed
  bool next();

  /// Of the row last read, without quotes and outer blanks; in the text.
  [[nodiscard]] std::span<const std::string_view> fields() const { return fields_; }
  [[nodiscard]] const LineReader& lines() const { return lines_; }

 private:
  bool next_line(std::string_view& line);
  void take_separator(std::string_view line);
  void split(std::string_view line);
  std::string_view take_quoted(std::string_view& rest) const;
  [[noreturn]] void wrong_count() const;

  LineReader lines_;
  std::vector<std::string> header_;
  std::vector<std::string_view> fields_;
  char separator_ = '\0';  ///< NUL: not known yet
};

}  // namespace barchan
