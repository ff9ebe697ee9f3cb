#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/column_names.hpp>
#include <barchan/core/io/csv_table.hpp>
#include <barchan/core/io/particle_columns.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/plain_text.hpp>

namespace barchan {
namespace {

/// A column of a table, by its number: all of kFileFields, then the diameter.
struct Column {
  std::string_view name;
  const FileField* field = nullptr;
  int component = 0;
};

constexpr std::size_t count_columns() {
  std::size_t n = 0;
  for (const FileField& field : kFileFields) n += static_cast<std::size_t>(field.num_components());
  return n;
}
constexpr std::size_t kDiameter = count_columns();

constexpr std::array<Column, kDiameter + 1> make_columns() {
  std::array<Column, kDiameter + 1> columns;
  std::size_t n = 0;
  for (const FileField& field : kFileFields) {
    for (int c = 0; c < field.num_components(); ++c)
      columns[n++] = {field.columns[static_cast<std::size_t>(c)], &field, c};
  }
  columns[kDiameter] = {"diameter"};
  return columns;
}
constexpr auto kColumns = make_columns();

constexpr int number_of(std::string_view name) {
  int number = 0;
  while (kColumns[static_cast<std::size_t>(number)].name != name) ++number;
  return number;
}
constexpr int kRadius = number_of("radius");

bool is_required(const Column& column) {
  constexpr int kAxesOfDisks = 2;
  return column.field != nullptr && column.field->is_required && column.component < kAxesOfDisks;
}

std::string all_names(bool has_heat) {
  std::string names;
  for (const Column& column : kColumns) {
    if (column.field != nullptr && (has_heat || !column.field->may_lack))
      names += (names.empty() ? "" : ",") + std::string(column.name);
  }
  return names;
}

std::vector<ColumnAlias> make_aliases() {
  std::vector<ColumnAlias> aliases;
  for (const Column& column : kColumns)
    aliases.push_back({std::string(column.name), number_of(column.name)});
  for (const FileField& field : kFileFields) {
    const int first = number_of(field.columns[0]);
    for (const std::string_view alias : field.aliases) {
      if (alias.empty()) continue;
      if (field.num_components() == 1) aliases.push_back({std::string(alias), first});
      if (field.num_components() > 1) add_vector_names(aliases, alias, first);
    }
  }
  constexpr int kNumber = static_cast<int>(kDiameter);
  aliases.push_back({"particlediameter", kNumber});
  for (int c = 0; c < 3; ++c)
    aliases.push_back({std::string(1, "xyz"[c]) + "u", number_of("x") + c});
  for (ColumnAlias& alias : aliases) {
    if (alias.column == kRadius) alias.alternative = kNumber;
    if (alias.column == kNumber) alias.alternative = kRadius;
  }
  return aliases;
}

void require_columns(const ColumnMap& map, const LineReader& lines) {
  for (const Column& column : kColumns) {
    const int number = number_of(column.name);
    const bool is_given = map.has(number) || (number == kRadius && map.has(kDiameter));
    if (!is_required(column) || is_given) continue;
    std::string required, optional;
    for (const Column& other : kColumns) {
      if (other.field == nullptr) continue;
      std::string& names = is_required(other) ? required : optional;
      names += (names.empty() ? "" : ",") + std::string(other.name);
    }
    const std::string unused = map.note();
    throw InputError(lines.place(), fmt::format("column '{}' is missing", column.name),
                     fmt::format("the header names {} and optionally {}{}{}", required, optional,
                                 unused.empty() ? "" : "; ", unused));
  }
}

ColumnMap map_header(const CsvTable& table) {
  static const std::vector<ColumnAlias> kAliases = make_aliases();
  std::array<std::string_view, kColumns.size()> names;
  std::transform(kColumns.begin(), kColumns.end(), names.begin(),
                 [](const Column& column) { return column.name; });
  ColumnMap map = map_columns(table.header(), kAliases, names, table.lines());
  if (map.has(kRadius)) map.drop(kDiameter, table.header());
  require_columns(map, table.lines());
  return map;
}

void store(ParticleData& particle, int number, std::string_view text, const LineReader& lines) {
  const Column& column = kColumns[static_cast<std::size_t>(number)];
  if (column.field == nullptr) {
    particle.radius = 0.5 * parse_number(text, column.name, lines);
    return;
  }
  const auto& value = column.field->value;
  if (const auto* id = std::get_if<std::int64_t ParticleData::*>(&value)) {
    particle.** id = parse_whole_number(text, column.name, lines);
  } else if (const auto* type = std::get_if<std::int32_t ParticleData::*>(&value)) {
    const std::int64_t whole = parse_whole_number(text, column.name, lines);
    const bool fits = whole >= 1 && whole <= std::numeric_limits<std::int32_t>::max();
    particle.** type = fits ? static_cast<std::int32_t>(whole - 1) : -1;
  } else if (const auto* real = std::get_if<double ParticleData::*>(&value)) {
    particle.** real = parse_number(text, column.name, lines);
  } else {
    (particle.*std::get<Vec3 ParticleData::*>(value))[column.component] =
        parse_number(text, column.name, lines);
  }
}

}  // namespace

ParticleFile parse_particles_csv(std::string_view text, const std::string& file) {
  const PlainText plain(text, file);
  CsvTable table(plain.view(), file);
  ParticleFile result;
  result.file = file;
  if (!table.header().empty()) {
    const ColumnMap map = map_header(table);
    if (const std::string note = map.note(); !note.empty()) result.notes.push_back(note);
    while (table.next()) {
      ParticleData particle;
      for (std::size_t i = 0; i < map.columns.size(); ++i) {
        if (map.columns[i] != ColumnMap::kUnused)
          store(particle, map.columns[i], table.fields()[i], table.lines());
      }
      check_particle_row(particle, table.lines());
      result.particles.push_back(particle);
      result.lines.push_back(table.lines().number());
    }
  }
  check_particle_file(result);
  return result;
}

void write_particles_csv(const std::string& path, std::span<const ParticleData> particles) {
  OutputFile file(path);
  const bool has_heat = have_heat(particles);
  file.write(all_names(has_heat) + "\n");
  fmt::memory_buffer row;
  const auto put = [&row](const auto& number) {
    if (row.size() > 0) row.push_back(',');
    if constexpr (std::is_integral_v<std::decay_t<decltype(number)>>)
      fmt::format_to(std::back_inserter(row), "{}", number);
    else
      fmt::format_to(std::back_inserter(row), "{:.17g}", number);
  };
  for (const ParticleData& p : particles) {
    row.clear();
    for (const FileField& field : kFileFields) {
      if (field.may_lack && !has_heat) continue;
      std::visit(
          [&]<class T>(T ParticleData::*member) {
            if constexpr (std::is_same_v<T, Vec3>)
              for (int c = 0; c < 3; ++c) put((p.*member)[c]);
            else
              put(std::is_same_v<T, std::int32_t> ? p.*member + T{1} : p.*member);
          },
          field.value);
    }
    row.push_back('\n');
    file.write({row.data(), row.size()});
  }
  file.commit();
}

}  // namespace barchan
