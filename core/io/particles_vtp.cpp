#include <limits>

#include <barchan/core/error.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/core/io/vtp.hpp>

namespace barchan {
namespace {

template <class Number>
const std::vector<Number>& values_of(const VtpPiece& piece, const char* name, int components,
                                     const std::string& file) {
  const VtpColumn* column = piece.find(name);
  const auto* values =
      column == nullptr ? nullptr : std::get_if<std::vector<Number>>(&column->values);
  if (values == nullptr || column->components != components) {
    throw InputError(SourcePlace{file, 0, 0},
                     "has no array " + in_quotes(name) + " of the expected type",
                     "id, type, radius, density, velocity and angular_velocity are needed");
  }
  return *values;
}

Vec3 row_of(const std::vector<double>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

void append_piece(ParticleFile& result, const VtpPiece& piece, const std::string& file) {
  if (piece.are_lines)
    throw InputError(SourcePlace{file, 0, 0}, "holds bonds, not particles",
                     "give the file of the particles, whose name lacks _bonds");
  const auto& id = values_of<std::int64_t>(piece, "id", 1, file);
  const auto& type = values_of<std::int32_t>(piece, "type", 1, file);
  const auto& radius = values_of<double>(piece, "radius", 1, file);
  const auto& density = values_of<double>(piece, "density", 1, file);
  const auto& velocity = values_of<double>(piece, "velocity", 3, file);
  const auto& omega = values_of<double>(piece, "angular_velocity", 3, file);
  const LineReader lines({}, file);
  for (std::size_t i = 0; i < id.size(); ++i) {
    ParticleData particle{id[i],           type[i] > 0 ? type[i] - 1 : -1, radius[i],
                          density[i],      row_of(piece.points, i),        row_of(velocity, i),
                          row_of(omega, i)};
    check_particle_row(particle, lines);
    if (!(particle.position.allFinite() && particle.velocity.allFinite() &&
          particle.omega.allFinite())) {
      throw InputError(lines.place(), "particle " + std::to_string(particle.id) + " is not finite",
                       "the file is damaged");
    }
    result.particles.push_back(particle);
    result.lines.push_back(0);
  }
}

}  // namespace

ParticleFile parse_particles_vtp(std::string_view text, const std::string& file) {
  ParticleFile result;
  result.file = file;
  append_piece(result, parse_vtp(text, file), file);
  return result;
}

void write_particles_vtp(const std::string& path, std::span<const ParticleData> particles) {
  std::vector<std::int64_t> id;
  std::vector<std::int32_t> type;
  std::vector<double> radius, density, points, velocity, omega;
  const auto append = [](std::vector<double>& to, const Vec3& v) {
    to.insert(to.end(), {v.x(), v.y(), v.z()});
  };
  for (const ParticleData& p : particles) {
    id.push_back(p.id);
    type.push_back(p.type + 1);
    radius.push_back(p.radius);
    density.push_back(p.density);
    append(points, p.position);
    append(velocity, p.velocity);
    append(omega, p.omega);
  }
  using Doubles = std::span<const double>;
  VtpArrays arrays;
  arrays.points = points;
  arrays.fields = {{"id", 1, std::span<const std::int64_t>(id)},
                   {"type", 1, std::span<const std::int32_t>(type)},
                   {"radius", 1, Doubles(radius)},
                   {"density", 1, Doubles(density)},
                   {"velocity", 3, Doubles(velocity)},
                   {"angular_velocity", 3, Doubles(omega)}};
  write_vtp(path, arrays);
}

}  // namespace barchan
