#include <barchan/tasks/results/departure_table.hpp>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan {

DepartureTable::DepartureTable(std::string path, int dimension, std::int64_t first_step)
    : path_(std::move(path)), dimension_(dimension) {
  if (!std::filesystem::exists(path_)) return;
  const std::string text = read_text_file(path_);
  // A last row without line feed is not trusted.
  LineReader lines(std::string_view(text).substr(0, text.find_last_of('\n') + 1), path_);
  std::string kept;
  std::string_view line;
  while (lines.next(line)) {
    std::int64_t step = -1;  // of the header
    (void)std::from_chars(line.data(), line.data() + line.size(), step);
    if (step < first_step) kept.append(line).push_back('\n');
  }
  OutputFile file(path_);
  file.write(kept.empty() ? header() : kept);
  file.commit();
}

std::string DepartureTable::header() const {
  return dimension_ == 2 ? "step,id,x,y,vx,vy\n" : "step,id,x,y,z,vx,vy,vz\n";
}

void DepartureTable::append(std::span<const Departure> departures) const {
  std::string rows = std::filesystem::exists(path_) ? "" : header();
  for (const Departure& d : departures) {
    rows += fmt::format("{},{}", d.step, d.id);
    for (const double* values : {d.position, d.velocity}) {
      for (int c = 0; c < dimension_; ++c) rows += fmt::format(",{:.17g}", values[c]);
    }
    rows += '\n';
  }
  std::FILE* file = std::fopen(path_.c_str(), "ab");
  bool is_good = file != nullptr && std::fwrite(rows.data(), 1, rows.size(), file) == rows.size();
  const int code = errno;
  if (file != nullptr) is_good = std::fclose(file) == 0 && is_good;
  if (!is_good) throw RunError("cannot write " + path_ + ": " + std::strerror(code));
}

}  // namespace barchan
