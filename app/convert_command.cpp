#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include <barchan/app/commands.hpp>
#include <barchan/app/readable.hpp>
#include <barchan/core/error.hpp>
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

void write(const ConvertArguments& arguments, const ParticleFile& file, int dimension) {
  const std::string& out = arguments.out;
  if (out.ends_with(".csv")) return write_particles_csv(out, file.particles);
  if (out.ends_with(".vtp")) return write_particles_vtp(out, file.particles);
  if (out.ends_with(".data") || out.ends_with(".lmp")) {
    return write_particles_lammps(out, file.particles, box_of(file, dimension), dimension);
  }
  throw InputError(SourcePlace{out, 0, 0}, "this ending names no format",
                   "write to .csv, .data, .lmp or .vtp");
}

}  // namespace

void convert(const ConvertArguments& arguments) {
  if (!arguments.force && std::filesystem::exists(arguments.out)) {
    throw InputError(SourcePlace{arguments.out, 0, 0}, "the file already exists",
                     "give another name, or --force");
  }
  ParticleFile file = read_particles(arguments.in);
  const int dimension = arguments.dimension != 0 ? arguments.dimension : (is_flat(file) ? 2 : 3);
  if (dimension == 2 && !is_flat(file)) {
    throw InputError(SourcePlace{arguments.in, 0, 0}, "holds particles off the plane z = 0",
                     "leave out --dimension 2");
  }
  if (dimension == 2) convert_to_areal_density(file);
  write(arguments, file, dimension);
  std::printf("%s: %s %s\n", arguments.out.c_str(),
              grouped(static_cast<std::int64_t>(file.particles.size())).c_str(),
              dimension == 2 ? "disks" : "spheres");
}

}  // namespace barchan::app
