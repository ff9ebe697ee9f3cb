#include <barchan/core/io/column_names.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/base/nearest.hpp>

namespace barchan {
namespace {

constexpr std::size_t kMaxName = 64;  // longer names are nobody's misspelling
constexpr std::array<std::string_view, 22> kUnits = {
    "m",   "mm",  "cm",   "um",   "µm",   "nm",  "km",   "in",   "ms",    "mms", "cms",
    "mps", "ms1", "kgm3", "kgm2", "gcm3", "rad", "rads", "rad1", "rads1", "rpm", "degs"};

constexpr std::array<std::string_view, 2> kForeign = {"pointid", "cellid"};  // of ParaView

bool is_letter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80;
}

/// Lower-case letters and digits of a name, and what is not ASCII.
std::string squeezed(std::string_view name) {
  std::string word;
  for (const char c : name) {
    if (is_letter(c))
      word.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  }
  return word;
}

/// A name without what stands in brackets at its end, unless that is a component as in velocity[0].
std::string_view without_unit(std::string_view name) {
  const std::size_t open = name.find_last_of("[(");
  if (open == std::string_view::npos || open == 0 || (name.back() != ']' && name.back() != ')'))
    return name;
  const std::string inside = squeezed(name.substr(open));
  const bool is_component = inside.size() == 1 && std::string_view("0123456789xyz").find(inside) !=
                                                      std::string_view::npos;
  return is_component ? name : trimmed(name.substr(0, open));
}

/// Does the rest of `name` behind `known` look like a unit?
bool has_unit(std::string_view name, std::string_view known) {
  if (!name.starts_with(known)) return false;
  const std::string_view rest = name.substr(known.size());
  return std::find(kUnits.begin(), kUnits.end(), rest) != kUnits.end();
}

bool is_near(std::string_view name, std::string_view known) {
  constexpr std::size_t kShort = 3, kMedium = 5;  // letters
  if (name.size() < kShort || name.size() > kMaxName) return false;
  if (known.starts_with(name)) return true;
  const std::size_t most = name.size() < kMedium ? 1 : 2;
  return known.size() >= 2 && deck::edit_distance(name, known) <= most;
}

std::string shown(const std::string& name) {
  return name.empty() ? "(unnamed)" : in_quotes(name);
}

/// The header of a table against the names that are known.
class Matcher {
 public:
  Matcher(std::span<const std::string> header, std::span<const ColumnAlias> aliases,
          std::span<const std::string_view> names, const LineReader& lines)
      : header_(header), aliases_(aliases), names_(names), lines_(lines) {}

  ColumnMap map() {
    for (const std::string& name : header_) {
      const bool has_no_unit = without_unit(name).size() == name.size();
      map_.columns.push_back(has_no_unit ? find(squeezed(name)) : ColumnMap::kUnused);
    }
    for (std::size_t i = 0; i < header_.size(); ++i) {
      refuse_twin(i);
      refuse_count_from_one(i);
    }
    for (std::size_t i = 0; i < header_.size(); ++i) {
      if (map_.columns[i] == ColumnMap::kUnused) judge_unused(header_[i]);
    }
    return std::move(map_);
  }

 private:
  [[nodiscard]] int find(std::string_view word) const {
    for (const ColumnAlias& alias : aliases_) {
      if (alias.name == word) return alias.column;
    }
    return ColumnMap::kUnused;
  }

  [[nodiscard]] bool is_given(const ColumnAlias& alias) const {
    return map_.has(alias.column) || (alias.alternative >= 0 && map_.has(alias.alternative));
  }

  [[nodiscard]] std::string_view name_of(int column) const {
    return names_[static_cast<std::size_t>(column)];
  }

  void refuse_twin(std::size_t i) const {
    const int column = map_.columns[i];
    if (column == ColumnMap::kUnused) return;
    const auto begin = map_.columns.begin();
    const auto first = std::find(begin, begin + static_cast<std::ptrdiff_t>(i), column);
    if (first == begin + static_cast<std::ptrdiff_t>(i)) return;
    const std::string& other = header_[static_cast<std::size_t>(first - begin)];
    const std::string what =
        other == header_[i]
            ? fmt::format("column {} appears twice", in_quotes(other))
            : fmt::format("columns {} and {} both give {}: it appears twice", in_quotes(other),
                          in_quotes(header_[i]), in_quotes(name_of(column)));
    throw InputError(lines_.place(), what, "keep one of them");
  }

  /// velocity_1 to velocity_3 must not be taken for velocity_0 to velocity_2, of which one is
  /// missing.
  void refuse_count_from_one(std::size_t i) const {
    std::string word = squeezed(header_[i]);
    if (map_.columns[i] == ColumnMap::kUnused || (word.back() != '1' && word.back() != '2')) return;
    word.back() = '0';
    if (find(word) == ColumnMap::kUnused) return;
    const auto is_first = [&](const std::string& name) { return squeezed(name) == word; };
    if (std::any_of(header_.begin(), header_.end(), is_first)) return;
    throw InputError(lines_.place(),
                     fmt::format("column {} without the one that ends in 0", in_quotes(header_[i])),
                     fmt::format("components count from 0: call it '{}' if it is that",
                                 name_of(map_.columns[i])));
  }

  /// Refuses a name that was meant to be a column's; others are listed.
  void judge_unused(const std::string& name) {
    const std::string_view plain = without_unit(name);
    const std::string word = squeezed(plain);
    if (plain.size() != name.size()) {
      const int column = find(word);
      if (column != ColumnMap::kUnused && !map_.has(column)) refuse_unit(name, column);
    }
    for (const ColumnAlias& alias : aliases_) {
      if (!is_given(alias) && has_unit(word, alias.name)) refuse_unit(name, alias.column);
    }
    if (const auto column = nearest(word))
      throw InputError(lines_.place(), fmt::format("column {} is not known", in_quotes(name)),
                       fmt::format("did you mean '{}'?", name_of(*column)));
    map_.unused.push_back(shown(name));
  }

  [[noreturn]] void refuse_unit(const std::string& name, int column) const {
    throw InputError(
        lines_.place(), fmt::format("column {} names a unit", in_quotes(name)),
        fmt::format("all is in SI units here: call it '{}' once it is in them", name_of(column)));
  }

  /// The column whose name comes closest, of those that are not given.
  [[nodiscard]] std::optional<int> nearest(std::string_view word) const {
    std::optional<int> best;
    if (std::find(kForeign.begin(), kForeign.end(), word) != kForeign.end()) return best;
    std::size_t best_distance = kMaxName;
    for (const ColumnAlias& alias : aliases_) {
      if (is_given(alias) || !is_near(word, alias.name)) continue;
      const std::size_t distance = deck::edit_distance(word, alias.name);
      if (distance < best_distance) best = alias.column;
      best_distance = std::min(best_distance, distance);
    }
    return best;
  }

  std::span<const std::string> header_;
  std::span<const ColumnAlias> aliases_;
  std::span<const std::string_view> names_;
  const LineReader& lines_;
  ColumnMap map_;
};

}  // namespace

void add_vector_names(std::vector<ColumnAlias>& aliases, std::string_view base, int first) {
  for (int c = 0; c < 3; ++c) {
    aliases.push_back({std::string(base) + "xyz"[c], first + c});
    if (!base.empty()) aliases.push_back({std::string(base) + "012"[c], first + c});
  }
}

bool ColumnMap::has(int column) const {
  return std::find(columns.begin(), columns.end(), column) != columns.end();
}

void ColumnMap::drop(int column, std::span<const std::string> header) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i] != column) continue;
    columns[i] = kUnused;
    unused.push_back(shown(header[i]));
  }
}

std::string ColumnMap::note() const {
  return unused.empty() ? "" : fmt::format("columns not used: {}", fmt::join(unused, ", "));
}

ColumnMap map_columns(std::span<const std::string> header, std::span<const ColumnAlias> aliases,
                      std::span<const std::string_view> names, const LineReader& lines) {
  return Matcher(header, aliases, names, lines).map();
}

}  // namespace barchan
