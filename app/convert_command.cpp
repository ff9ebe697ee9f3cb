#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include <barchan/app/commands.hpp>
#include <barchan/app/readable.hpp>
#include <barchan/app/warning.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/io/particle_file.hpp>

namespace barchan::app {
namespace {

bool is_flat(const ParticleFile& file) {
  return std::all_of(file.particles.begin(), file.particles.end(), [](const ParticleData& p) {
    return p.position.z() == 0.0 && p.velocity.z() == 0.0 && p.omega.x() == 0.0 &&
           p.omega.y() == 0.0;
  });
}

Box box_of(const ParticleFile& file, int dimension) {
  if (file.box) return *file.box;
  Box box{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
  for (const ParticleData& p : file.particles) {
    box.lo = box.lo.cwiseMin(p.position - Vec3::Constant(p.radius));
    box.hi = box.hi.cwiseMax(p.position + Vec3::Constant(p.radius));
  }
  if (dimension == 2) box.lo.z() = box.hi.z() = 0.0;
  return box;
}

/// The format of the file to write, found before anything is read.
ParticleFormat format_of(const std::string& out) {
  const auto format = particle_format(out);
  if (!format || *format == ParticleFormat::Pvtp || is_packed(out)) {
    throw InputError(SourcePlace{out, 0, 0}, "this ending names no format that is written",
                     "write to .csv, .data, .lmp or .vtp");
  }
  return *format;
}

void refuse_existing(const ConvertArguments& arguments, const std::string& path) {
  if (arguments.force || !std::filesystem::exists(path)) return;
  throw InputError(SourcePlace{path, 0, 0}, "the file already exists",
                   "give another name, or --force");
}

void write(const ConvertArguments& arguments, const ParticleFile& file, ParticleFormat format,
           int dimension) {
  const std::string& out = arguments.out;
  const std::string beside = bonds_path(out);
  if (format == ParticleFormat::LammpsData) {
    return write_particles_lammps(
        out, file.particles, file.bonds,
        {box_of(file, dimension), dimension, arguments.density != "disk", file.has_bonds});
  }
  const bool is_csv = format == ParticleFormat::Csv;
  if (!file.has_bonds) {
    std::filesystem::remove(beside);  // of another file
  } else if (is_csv) {
    write_bonds_csv(beside, file.bonds);
  } else {
    write_bonds_vtp(beside, file.particles, file.bonds);
  }
  is_csv ? write_particles_csv(out, file.particles) : write_particles_vtp(out, file.particles);
}

std::string what_was_written(const ConvertArguments& arguments, const ParticleFile& file,
                             ParticleFormat format, int dimension) {
  const auto count = [](std::size_t n) { return grouped(static_cast<std::int64_t>(n)); };
  std::string text = fmt::format("{}: {} {}", arguments.out, count(file.particles.size()),
                                 dimension == 2 ? "disks" : "spheres");
  if (!file.has_bonds) return text;
  text += fmt::format(", {} bonds", count(file.bonds.size()));
  if (format != ParticleFormat::LammpsData) text += " in " + bonds_path(arguments.out);
  return text;
}

}  // namespace

void convert(const ConvertArguments& arguments) {
  const ParticleFormat format = format_of(arguments.out);
  refuse_existing(arguments, arguments.out);
  if (format != ParticleFormat::LammpsData) refuse_existing(arguments, bonds_path(arguments.out));
  ParticleFile file = read_particles(arguments.in);
  for (const std::string& note : file.notes) print_warning(file.file + ": " + note);
  const int dimension = arguments.dimension != 0 ? arguments.dimension : (is_flat(file) ? 2 : 3);
  if (dimension == 2 && !is_flat(file)) {
    throw InputError(SourcePlace{arguments.in, 0, 0}, "holds particles off the plane z = 0",
                     "leave out --dimension 2");
  }
  if (arguments.density == "disk") file.has_sphere_density = false;
  if (dimension == 2) convert_to_areal_density(file);
  write(arguments, file, format, dimension);
  std::printf("%s\n", what_was_written(arguments, file, format, dimension).c_str());
}

}  // namespace barchan::app
