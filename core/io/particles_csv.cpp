#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include <barchan/core/error.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan {
namespace {

enum Column { Id, Type, Radius, Density, X, Y, Z, Vx, Vy, Vz, OmegaX, OmegaY, OmegaZ, kNumColumns };

constexpr std::array<std::string_view, kNumColumns> kNames = {
    "id", "type", "radius", "density", "x",      "y",     "z",
    "vx", "vy",   "vz",     "omegax",  "omegay", "omegaz"};
constexpr int kNumRequired = Y + 1;
constexpr int kIgnored = -1;
constexpr std::size_t kMaxFields = 1000;

/// Which column each field of a row is; kIgnored for those that are none of ours.
using Layout = std::vector<int>;

bool is_skipped(std::string_view line) {
  const std::string_view text = trimmed(line);
  return text.empty() || text.front() == '#';
}

std::string_view take_field(std::string_view& rest, bool& is_last) {
  const std::size_t comma = rest.find(',');
  const std::string_view field = rest.substr(0, comma);
  is_last = comma == std::string_view::npos;
  if (!is_last) rest.remove_prefix(comma + 1);
  return trimmed(field);
}

std::string_view without_quotes(std::string_view name) {
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"')
    return name.substr(1, name.size() - 2);
  return name;
}

void check_columns(const Layout& layout, const LineReader& lines) {
  for (int column = 0; column < kNumColumns; ++column) {
    const auto count = std::count(layout.begin(), layout.end(), column);
    const std::string name = in_quotes(kNames[static_cast<std::size_t>(column)]);
    if (count > 1)
      throw InputError(lines.place(), "column " + name + " appears twice", "keep one of them");
    if (count == 0 && column < kNumRequired) {
      throw InputError(lines.place(), "column " + name + " is missing",
                       "the header names id,type,radius,density,x,y and optionally "
                       "z,vx,vy,vz,omegax,omegay,omegaz");
    }
  }
}

Layout read_header(std::string_view line, const LineReader& lines) {
  Layout layout;
  bool is_last = false;
  while (!is_last) {
    const std::string_view name = without_quotes(take_field(line, is_last));
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    layout.push_back(found == kNames.end() ? kIgnored : static_cast<int>(found - kNames.begin()));
    if (layout.size() > kMaxFields)
      throw InputError(lines.place(), "more than 1000 columns", "is this a particle table?");
  }
  check_columns(layout, lines);
  return layout;
}

void store(ParticleData& particle, int column, std::string_view field, const LineReader& lines) {
  const std::string_view name = kNames[static_cast<std::size_t>(column)];
  if (column == Id) {
    particle.id = parse_integer(field, name, lines);
  } else if (column == Type) {
    const std::int64_t type = parse_integer(field, name, lines);
    const bool fits = type >= 1 && type <= std::numeric_limits<std::int32_t>::max();
    particle.type = fits ? static_cast<std::int32_t>(type - 1) : -1;
  } else {
    const double value = parse_number(field, name, lines);
    if (column == Radius) particle.radius = value;
    if (column == Density) particle.density = value;
    if (column >= X && column <= Z) particle.position[column - X] = value;
    if (column >= Vx && column <= Vz) particle.velocity[column - Vx] = value;
    if (column >= OmegaX) particle.omega[column - OmegaX] = value;
  }
}

[[noreturn]] void wrong_count(const Layout& layout, std::size_t count, const LineReader& lines) {
  throw InputError(lines.place(), fmt::format("{} fields", count),
                   fmt::format("the header has {} columns", layout.size()));
}

ParticleData read_row(std::string_view line, const Layout& layout, const LineReader& lines) {
  ParticleData particle;
  bool is_last = false;
  std::size_t count = 0;
  while (!is_last) {
    const std::string_view field = take_field(line, is_last);
    if (count < layout.size() && layout[count] != kIgnored) {
      if (field.empty() && is_last) wrong_count(layout, count, lines);
      store(particle, layout[count], field, lines);
    }
    ++count;
    if (is_last ? count != layout.size() : count > layout.size()) {
      wrong_count(layout,
                  count + static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')),
                  lines);
    }
  }
  check_particle_row(particle, lines);
  return particle;
}

}  // namespace

ParticleFile parse_particles_csv(std::string_view text, const std::string& file) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  LineReader lines(text, file);
  ParticleFile result;
  result.file = file;
  Layout layout;
  std::string_view line;
  while (lines.next(line)) {
    if (is_skipped(line)) continue;
    if (layout.empty()) {
      layout = read_header(line, lines);
      continue;
    }
    result.particles.push_back(read_row(line, layout, lines));
    result.lines.push_back(lines.number());
  }
  check_particle_file(result);
  return result;
}

ParticleFile read_particles_csv(const std::string& path) {
  return parse_particles_csv(read_text_file(path), path);
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
