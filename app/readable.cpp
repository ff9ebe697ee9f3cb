#include <barchan/app/readable.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace barchan::app {
namespace {

std::string scaled(double number, double base, const std::vector<const char*>& units) {
  std::size_t unit = 0;
  while (std::fabs(number) >= 0.9995 * base && unit + 1 < units.size()) {
    number /= base;
    ++unit;
  }
  const int digits =
      number >= 100.0 || (unit == 0 && number == std::floor(number)) ? 0 : (number >= 10.0 ? 1 : 2);
  const std::string text = fmt::format("{:.{}f}", number, digits);
  return *units[unit] == '\0' ? text : text + " " + units[unit];
}

}  // namespace

std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string grouped(std::int64_t number) {
  const std::string digits = std::to_string(number < 0 ? -number : number);
  std::string text;
  if (number < 0) text.push_back('-');
  for (std::size_t k = 0; k < digits.size(); ++k) {
    if (k > 0 && (digits.size() - k) % 3 == 0) text.push_back(',');
    text.push_back(digits[k]);
  }
  return text;
}

std::string readable_rate(double per_second) {
  return scaled(per_second, 1000.0, {"", "k", "M", "G", "T"});
}

std::string readable_bytes(double bytes) {
  return scaled(bytes, 1024.0, {"B", "KiB", "MiB", "GiB", "TiB"});
}

std::string readable_time(double seconds) {
  if (!(seconds < 1e9)) return "?";
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string readable_seconds(double seconds) {
  if (seconds <= 0.0) return "0 s";
  if (seconds < 1e-3) return fmt::format("{:.3g} µs", 1e6 * seconds);
  if (seconds < 1.0) return fmt::format("{:.3g} ms", 1e3 * seconds);
  return seconds < 100.0 ? fmt::format("{:.3g} s", seconds) : fmt::format("{:.0f} s", seconds);
}

std::string percent(double share) {
  const double value = 100.0 * share;
  return value > 0.0 && value < 9.95 ? fmt::format("{:.1f} %", value)
                                     : fmt::format("{:.0f} %", value);
}

std::string range(double lo, double hi) {
  const std::string first = fmt::format("{:.4g}", lo), last = fmt::format("{:.4g}", hi);
  return first == last ? first : first + " … " + last;
}

std::string table(const std::vector<std::vector<std::string>>& rows, std::size_t num_left) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width_of(row[c]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line = "  ";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string space(widths[c] - width_of(row[c]), ' ');
      line += c < num_left ? row[c] + space : space + row[c];
      line += "  ";
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace barchan::app
