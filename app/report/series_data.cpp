#include <barchan/app/report/series_data.hpp>

#include <charconv>

#include <barchan/app/experiments/axes.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan::app {
namespace {

constexpr std::size_t kMostRows = 4000;

PageData cell(const std::string& text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  return read.ec == std::errc() && read.ptr == end ? PageData(value) : PageData(nullptr);
}

}  // namespace

PageData series_data(const std::string& path) {
  const std::string text = read_text_file(path);
  LineReader lines(text, path);
  std::string_view line;
  PageData data{{"columns", PageData::array()}, {"rows", PageData::array()}};
  if (!lines.next(line)) return data;
  for (const std::string& name : split(line, ',')) data["columns"].push_back(name);
  std::vector<std::string_view> kept;
  while (lines.next(line)) kept.push_back(line);
  if (!kept.empty() && !text.ends_with('\n')) kept.pop_back();  // a run is just writing it
  const std::size_t every = 1 + kept.size() / kMostRows;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (k % every != 0 && k + 1 != kept.size()) continue;
    PageData row = PageData::array();
    for (const std::string& word : split(kept[k], ',')) row.push_back(cell(word));
    data["rows"].push_back(std::move(row));
  }
  return data;
}

}  // namespace barchan::app
