#include <barchan/core/io/particle_file.hpp>

#include <algorithm>
#include <numeric>

#include <barchan/core/error.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan {

ParticleFile read_particles(const std::string& path) {
  if (path.ends_with(".vtp") || path.ends_with(".pvtp")) return read_particles_vtp(path);
  const bool is_lammps = path.ends_with(".data") || path.ends_with(".lmp");
  return is_lammps ? read_particles_lammps(path) : read_particles_csv(path);
}

void convert_to_areal_density(ParticleFile& file) {
  if (!file.has_sphere_density) return;
  for (ParticleData& particle : file.particles) particle.density *= 4.0 / 3.0 * particle.radius;
  file.has_sphere_density = false;
}

void check_particle_row(const ParticleData& particle, const LineReader& lines) {
  const auto refuse = [&](const std::string& what, const char* remedy) {
    throw InputError(lines.place(), "particle " + std::to_string(particle.id) + " " + what, remedy);
  };
  if (particle.id < 1) refuse("has no valid id", "ids count from 1");
  if (particle.type < 0) refuse("has no valid type", "types count from 1");
  if (!(particle.radius > 0.0))
    refuse("has a radius that is not positive", "a radius is above zero [m]");
  if (!(particle.density > 0.0))
    refuse("has a density that is not positive", "a density is above zero [kg/m³]");
}

void check_particle_file(const ParticleFile& file) {
  const std::vector<ParticleData>& particles = file.particles;
  if (particles.empty())
    throw InputError(SourcePlace{file.file, 0, 0}, "holds no particles", "add a row per particle");
  const auto id_below = [&](std::size_t a, std::size_t b) {
    return particles[a].id < particles[b].id;
  };
  std::vector<std::size_t> order(particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!std::is_sorted(order.begin(), order.end(), id_below)) {
    std::stable_sort(order.begin(), order.end(), id_below);
  }
  const auto same_id = [&](std::size_t a, std::size_t b) {
    return particles[a].id == particles[b].id;
  };
  const auto twin = std::adjacent_find(order.begin(), order.end(), same_id);
  if (twin == order.end()) return;
  const std::int64_t first = file.lines[*twin];
  const std::int64_t second = file.lines[*std::next(twin)];
  throw InputError(SourcePlace{file.file, second, 0},
                   "particle id " + std::to_string(particles[*twin].id) +
                       " is already used in line " + std::to_string(first),
                   "every id may appear once");
}

}  // namespace barchan
