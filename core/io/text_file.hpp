#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include <barchan/core/base/error.hpp>

// Plain files: whole-file reading, line by line parsing with places for errors, writing that is
// complete or absent.

namespace barchan {

/// Reads a regular file as it is.
/// @throws InputError when it is missing, unreadable, no regular file, or does not fit in memory
[[nodiscard]] std::string read_text_file(const std::string& path);

/// A new file that appears under its name only by commit(): until then it has a temporary name
/// beside it. Left without commit(), it removes what it wrote. @throws RunError naming file and
/// cause (full disk, ...)
class OutputFile {
 public:
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes);
  void commit();

 private:
  [[noreturn]] void fail(const char* verb) const;

  std::string path_;
  std::string temporary_;
  std::FILE* file_ = nullptr;
};

/// Cuts a text into lines; a final line without line feed counts, carriage returns before a line
/// feed do not.
class LineReader {
 public:
  LineReader(std::string_view text, std::string_view file) : rest_(text), file_(file) {}

  /// False at the end of the text.
  [[nodiscard]] bool next(std::string_view& line);
  [[nodiscard]] std::int64_t number() const { return number_; }  ///< of the line last read, from 1

  /// Place of `part`, a piece of the line last read.
  [[nodiscard]] SourcePlace place(std::string_view part) const;
  [[nodiscard]] SourcePlace place() const { return {std::string(file_), number_, 0}; }

 private:
  std::string_view rest_;
  std::string_view file_;
  std::string_view line_;
  std::int64_t number_ = 0;
};

[[nodiscard]] std::string_view trimmed(std::string_view text);

/// The next word of `line` (cut at blanks), which is taken off; empty at the end.
[[nodiscard]] std::string_view take_word(std::string_view& line);

/// The text in quotes for a message: shortened, without control characters.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// A finite number from the whole of `text`. @throws InputError at its place in `lines`, naming
/// `what`
[[nodiscard]] double parse_number(std::string_view text, std::string_view what,
                                  const LineReader& lines);
[[nodiscard]] std::int64_t parse_integer(std::string_view text, std::string_view what,
                                         const LineReader& lines);
/// The same, where programs that know no integers may have written 1.0 or 1e3.
[[nodiscard]] std::int64_t parse_whole_number(std::string_view text, std::string_view what,
                                              const LineReader& lines);

}  // namespace barchan
