#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include <barchan/core/error.hpp>
#include <barchan/core/io/column_names.hpp>
#include <barchan/core/io/csv_table.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/plain_text.hpp>

namespace barchan {
namespace {

enum Column {
  Id,
  Type,
  Radius,
  Density,
  X,
  Y,
  Z,
  Vx,
  Vy,
  Vz,
  OmegaX,
  OmegaY,
  OmegaZ,
  Diameter,
  kNumColumns
};

constexpr std::array<std::string_view, kNumColumns> kNames = {
    "id", "type", "radius", "density", "x",      "y",      "z",
    "vx", "vy",   "vz",     "omegax",  "omegay", "omegaz", "diameter"};
constexpr int kNumRequired = Y + 1;

std::vector<ColumnAlias> make_aliases() {
  std::vector<ColumnAlias> aliases{
      {"id", Id},         {"particleid", Id},   {"particleidentifier", Id},
      {"atomid", Id},     {"type", Type},       {"particletype", Type},
      {"atomtype", Type}, {"density", Density}, {"particledensity", Density}};
  for (const std::string part : {"", "particle"}) {
    aliases.push_back({part + "radius", Radius, Diameter});
    aliases.push_back({part + "diameter", Diameter, Radius});
  }
  for (const char* base : {"", "position", "pos", "points", "point", "coordinates", "coord"})
    add_vector_names(aliases, base, X);
  for (const char* base : {"v", "velocity", "vel"}) add_vector_names(aliases, base, Vx);
  for (const char* base : {"omega", "angularvelocity", "angvel", "w"})
    add_vector_names(aliases, base, OmegaX);
  for (int c = 0; c < 3; ++c) aliases.push_back({std::string(1, "xyz"[c]) + "u", X + c});
  return aliases;
}

void require_columns(const ColumnMap& map, const LineReader& lines) {
  for (int column = 0; column < kNumRequired; ++column) {
    if (map.has(column) || (column == Radius && map.has(Diameter))) continue;
    const std::string unused = map.note();
    throw InputError(
        lines.place(),
        fmt::format("column '{}' is missing", kNames[static_cast<std::size_t>(column)]),
        "the header names id,type,radius,density,x,y and optionally "
        "z,vx,vy,vz,omegax,omegay,omegaz" +
            (unused.empty() ? "" : "; " + unused));
  }
}

ColumnMap map_header(const CsvTable& table) {
  static const std::vector<ColumnAlias> kAliases = make_aliases();
  ColumnMap map = map_columns(table.header(), kAliases, kNames, table.lines());
  if (map.has(Radius)) map.drop(Diameter, table.header());
  require_columns(map, table.lines());
  return map;
}

void store(ParticleData& particle, int column, std::string_view field, const LineReader& lines) {
  const std::string_view name = kNames[static_cast<std::size_t>(column)];
  if (column == Id) {
    particle.id = parse_whole_number(field, name, lines);
  } else if (column == Type) {
    const std::int64_t type = parse_whole_number(field, name, lines);
    const bool fits = type >= 1 && type <= std::numeric_limits<std::int32_t>::max();
    particle.type = fits ? static_cast<std::int32_t>(type - 1) : -1;
  } else {
    const double value = parse_number(field, name, lines);
    if (column == Radius) particle.radius = value;
    if (column == Diameter) particle.radius = 0.5 * value;
    if (column == Density) particle.density = value;
    if (column >= X && column <= Z) particle.position[column - X] = value;
    if (column >= Vx && column <= Vz) particle.velocity[column - Vx] = value;
    if (column >= OmegaX && column <= OmegaZ) particle.omega[column - OmegaX] = value;
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
  file.write("id,type,radius,density,x,y,z,vx,vy,vz,omegax,omegay,omegaz\n");
  fmt::memory_buffer row;
  for (const ParticleData& p : particles) {
    row.clear();
    fmt::format_to(std::back_inserter(row), "{},{},{:.17g},{:.17g}", p.id, p.type + 1, p.radius,
                   p.density);
    for (const Vec3* v : {&p.position, &p.velocity, &p.omega}) {
      fmt::format_to(std::back_inserter(row), ",{:.17g},{:.17g},{:.17g}", v->x(), v->y(), v->z());
    }
    row.push_back('\n');
    file.write({row.data(), row.size()});
  }
  file.commit();
}

}  // namespace barchan
