#include <barchan/core/io/text_file.hpp>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <new>

#include <sys/stat.h>
#include <unistd.h>

namespace barchan {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1}
                                  << 36;  // 64 GiB: several hundred million particles
constexpr std::string_view kBlanks = " \t\r\f\v";

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void cannot_read(const std::string& path, const std::string& why,
                              const std::string& remedy) {
  throw InputError(SourcePlace{path, 0, 0}, "cannot be read: " + why, remedy);
}

std::string read_all(std::FILE* file, const std::string& path, std::size_t size) {
  std::string text(size, '\0');
  const std::size_t got = std::fread(text.data(), 1, size, file);
  if (std::ferror(file)) cannot_read(path, std::strerror(errno), "check the disk");
  text.resize(got);
  return text;
}

}  // namespace

std::string read_text_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    cannot_read(path, std::strerror(errno), "give the path of an existing file");
  }
  if (!S_ISREG(status.st_mode)) cannot_read(path, "not a regular file", "give the path of a file");
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > kMaxBytes) cannot_read(path, "larger than 64 GiB", "split it");

  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) cannot_read(path, std::strerror(errno), "check its permissions");
  try {
    return read_all(file.get(), path, size);
  } catch (const std::bad_alloc&) {
    cannot_read(path, "does not fit in memory", "split it or use a machine with more memory");
  }
}

OutputFile::OutputFile(std::string path)
    : path_(std::move(path)), temporary_(path_ + ".tmp" + std::to_string(::getpid())) {
  file_ = std::fopen(temporary_.c_str(), "wb");
  if (file_ == nullptr) fail("create");
}

OutputFile::~OutputFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  std::remove(temporary_.c_str());
}

void OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("write");
}

void OutputFile::commit() {
  if (std::fflush(file_) != 0) fail("write");
  const int closed = std::fclose(file_);
  file_ = nullptr;
  if (closed != 0 || std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const int cause = errno;
    std::remove(temporary_.c_str());
    errno = cause;
    fail("write");
  }
}

void OutputFile::fail(const char* verb) const {
  throw RunError("cannot " + std::string(verb) + " " + path_ + ": " + std::strerror(errno));
}

bool LineReader::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  ++number_;
  line = line_;
  return true;
}

SourcePlace LineReader::place(std::string_view part) const {
  return {std::string(file_), number_, part.data() - line_.data() + 1};
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return text.substr(text.size());
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string_view take_word(std::string_view& line) {
  const std::size_t first = std::min(line.find_first_not_of(kBlanks), line.size());
  const std::size_t last = std::min(line.find_first_of(kBlanks, first), line.size());
  const std::string_view word = line.substr(first, last - first);
  line.remove_prefix(last);
  return word;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string safe(text.substr(0, kLongest));
  for (char& c : safe) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return "'" + safe + (text.size() > kLongest ? "..." : "") + "'";
}

namespace {

template <class Number>
std::from_chars_result scan(std::string_view text, Number& value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  std::from_chars_result result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec == std::errc{} && result.ptr != text.data() + text.size()) {
    result.ec = std::errc::invalid_argument;
  }
  return result;
}

/// The number that it would be with a decimal point; empty when there is no decimal comma.
std::string with_point(std::string_view text) {
  std::string number(text);
  const std::size_t comma = number.find(',');
  double ignored = 0.0;
  if (comma == std::string::npos) return {};
  number[comma] = '.';
  return scan(std::string_view(number), ignored).ec == std::errc{} ? number : std::string();
}

[[noreturn]] void malformed(std::string_view text, std::string_view what, const LineReader& lines,
                            const char* kind,
                            const char* remedy = "a number such as 1.5e-3 belongs here") {
  if (const std::string number = with_point(text); !number.empty()) {
    const bool may_be_thousands = text.size() - text.find(',') == 4;  // 2,650
    throw InputError(lines.place(text),
                     std::string(what) + " is " + in_quotes(text) + ", which has " +
                         (may_be_thousands ? "a comma" : "a decimal comma"),
                     may_be_thousands ? "write a decimal point, and no mark between thousands"
                                      : "write a decimal point: " + number);
  }
  throw InputError(lines.place(text),
                   std::string(what) + " is " + in_quotes(text) + ", which is not " + kind, remedy);
}

}  // namespace

double parse_number(std::string_view text, std::string_view what, const LineReader& lines) {
  double value = 0.0;
  const auto result = scan(text, value);
  if (result.ec == std::errc::result_out_of_range)
    malformed(text, what, lines, "within the range of a double");
  if (result.ec != std::errc{}) malformed(text, what, lines, "a number");
  if (!std::isfinite(value)) malformed(text, what, lines, "finite");
  return value;
}

std::int64_t parse_integer(std::string_view text, std::string_view what, const LineReader& lines) {
  std::int64_t value = 0;
  const auto result = scan(text, value);
  if (result.ec == std::errc::result_out_of_range)
    malformed(text, what, lines, "within 64 bits", "ids go up to 4611686018427387903");
  if (result.ec != std::errc{})
    malformed(text, what, lines, "a whole number", "a whole number such as 12 belongs here");
  return value;
}

std::int64_t parse_whole_number(std::string_view text, std::string_view what,
                                const LineReader& lines) {
  constexpr double kExact = 9007199254740992.0;  // 2^53: doubles below it are spaced by one or less
  double value = 0.0;
  const bool is_whole = scan(text, value).ec == std::errc{} && std::fabs(value) < kExact &&
                        value == std::trunc(value);
  std::int64_t integer = 0;
  if (scan(text, integer).ec == std::errc{} || !is_whole) return parse_integer(text, what, lines);
  return static_cast<std::int64_t>(value);
}

}  // namespace barchan
