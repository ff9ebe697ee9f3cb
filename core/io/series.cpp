#include <barchan/core/io/series.hpp>

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan {
namespace {

std::string header_of(std::span<const std::string> further_columns) {
  std::string header = "step,time,kinetic_energy,contacts,max_overlap";
  for (const std::string& column : further_columns) header += "," + column;
  return header;
}

std::string_view first_line(std::string_view text) {
  return text.substr(0, text.find('\n'));
}

void replace_file(const std::string& path, const std::string& text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

/// Keeps a table with other columns under another name. @return the name
std::string put_aside(const std::string& path, const std::string& text, std::int64_t step) {
  const std::string header(first_line(text));
  const bool is_ours = header.starts_with(header_of({}));
  const std::string kept = is_ours ? kept_rows(text, path, header, step) : text;
  const std::filesystem::path whole(path);
  std::filesystem::path former;
  for (int number = 1; former.empty() || std::filesystem::exists(former); ++number)
    former = whole.parent_path() / fmt::format("{}_{}.csv", whole.stem().string(), number);
  replace_file(former.string(), kept);
  return former.string();
}

}  // namespace

std::string kept_rows(std::string_view text, const std::string& path, const std::string& header,
                      std::int64_t step) {
  LineReader lines(text.substr(0, text.find_last_of('\n') + 1), path);
  std::string_view line;
  if (!lines.next(line)) return header + "\n";
  if (line != header) {
    throw InputError(lines.place(), "the series has other columns than this run",
                     "expected " + header);
  }
  std::string kept = header + "\n";
  while (lines.next(line)) {
    std::int64_t row_step = 0;
    const auto result = std::from_chars(line.data(), line.data() + line.size(), row_step);
    if (result.ec != std::errc{})
      throw InputError(lines.place(), "a row without step", "remove the damaged row");
    if (row_step > step) break;
    kept.append(line).push_back('\n');
  }
  return kept;
}

std::string damage_of_rows(std::string_view kept, std::int64_t restart, std::int64_t interval) {
  LineReader lines(kept, "");
  std::string_view line;
  if (!lines.next(line)) return "there is no header";
  const auto num_columns = std::count(line.begin(), line.end(), ',');
  std::vector<std::int64_t> steps;
  while (lines.next(line)) {
    std::int64_t step = -1;
    std::from_chars(line.data(), line.data() + line.size(), step);
    if (std::count(line.begin(), line.end(), ',') != num_columns)
      return fmt::format("the row of step {} has other columns than the header", step);
    if (!steps.empty() && step <= steps.back())
      return fmt::format("step {} comes after step {}", step, steps.back());
    steps.push_back(step);
  }
  if (steps.empty()) return fmt::format("there is no row before step {}", restart);
  steps.push_back(restart);  // its own row is about to be written
  std::int64_t before = interval;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const std::int64_t gap = steps[i] - steps[i - 1];
    const bool is_of_rows = i + 2 < steps.size();  // the last gap may be any part of an interval
    const std::int64_t after = is_of_rows ? steps[i + 1] - steps[i] : interval;
    if (gap > before && gap > after)
      return fmt::format("rows between step {} and step {} are missing", steps[i - 1], steps[i]);
    before = gap;
  }
  return {};
}

SeriesWriter::SeriesWriter(std::string path, std::size_t num_further, const char* mode)
    : path_(std::move(path)), num_further_(num_further), file_(std::fopen(path_.c_str(), mode)) {
  if (file_ == nullptr) throw RunError("cannot create " + path_ + ": " + std::strerror(errno));
}

SeriesWriter::SeriesWriter(SeriesWriter&& other) noexcept
    : path_(std::move(other.path_)),
      former_(std::move(other.former_)),
      num_further_(other.num_further_),
      file_(std::exchange(other.file_, nullptr)),
      size_(other.size_) {}

SeriesWriter::~SeriesWriter() {
  if (file_ != nullptr) std::fclose(file_);
}

std::string SeriesWriter::damage(std::int64_t restart, std::int64_t interval) const {
  if (!former_.empty())
    return path_ + " had other columns than this run: its rows are kept in " + former_;
  const std::string what = damage_of_rows(read_text_file(path_), restart, interval);
  if (what.empty()) return {};
  return path_ + ": " + what +
         "; it was changed since the run wrote it, and further rows are appended to what is there";
}

SeriesWriter SeriesWriter::create(const std::string& path,
                                  std::span<const std::string> further_columns) {
  { const SeriesWriter emptied(path, 0, "wb"); }
  SeriesWriter series(path, further_columns.size(), "ab");  // so that a file cut short shows
  series.put(header_of(further_columns) + "\n");
  return series;
}

SeriesWriter SeriesWriter::resume(const std::string& path,
                                  std::span<const std::string> further_columns, std::int64_t step) {
  if (!std::filesystem::exists(path)) return create(path, further_columns);
  const std::string text = read_text_file(path), header = header_of(further_columns);
  if (!text.empty() && first_line(text) != header) {
    const std::string former = put_aside(path, text, step);
    SeriesWriter series = create(path, further_columns);
    series.former_ = former;
    return series;
  }
  const std::string kept = kept_rows(text, path, header, step);
  replace_file(path, kept);
  SeriesWriter series(path, further_columns.size(), "ab");
  series.size_ = static_cast<std::int64_t>(kept.size());
  return series;
}

void SeriesWriter::append(const SeriesRow& row, std::span<const std::optional<double>> further) {
  if (further.size() != num_further_)
    throw std::logic_error("series: one value per further column is needed");
  std::string text = fmt::format("{},{:.17g},{:.17g},{},{:.17g}", row.step, row.time,
                                 row.kinetic_energy, row.contacts, row.max_overlap);
  for (const std::optional<double>& value : further) {
    text.push_back(',');
    if (value) fmt::format_to(std::back_inserter(text), "{:.17g}", *value);
  }
  put(text + "\n");
}

void SeriesWriter::put(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size() || std::fflush(file_) != 0) {
    throw RunError("cannot write " + path_ + ": " + std::strerror(errno));
  }
  size_ += static_cast<std::int64_t>(text.size());
  struct stat now {};
  if (::fstat(::fileno(file_), &now) != 0 || now.st_nlink == 0)
    throw RunError(path_ + " was removed while the run was writing it");
  if (S_ISREG(now.st_mode) && now.st_size != size_)
    throw RunError(path_ + " was changed by another program while the run was writing it");
}

}  // namespace barchan
