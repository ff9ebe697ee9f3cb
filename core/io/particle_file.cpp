#include <barchan/core/io/particle_file.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/gzip.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/core/io/vtp.hpp>

namespace barchan {
namespace {

constexpr std::string_view kPacked = ".gz";

std::string lower_case(std::string_view text) {
  std::string word(text);
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word;
}

std::string_view without_packing(std::string_view path) {
  if (is_packed(path)) path.remove_suffix(kPacked.size());
  return path;
}

void append(ParticleFile& to, ParticleFile&& piece) {
  to.particles.insert(to.particles.end(), piece.particles.begin(), piece.particles.end());
  to.lines.insert(to.lines.end(), piece.lines.begin(), piece.lines.end());
}

ParticleFile read_pieces(const std::string& path) {
  ParticleFile result;
  for (const std::string& piece : read_pvtp(path))
    append(result, parse_particles_vtp(read_unpacked_file(piece), piece));
  result.file = path;
  check_particle_file(result);
  return result;
}

ParticleFile read_alone(const std::string& path, ParticleFormat format) {
  if (format == ParticleFormat::Pvtp) return read_pieces(path);
  const std::string text = read_unpacked_file(path);
  if (format == ParticleFormat::Vtp) {
    ParticleFile file = parse_particles_vtp(text, path);
    check_particle_file(file);
    return file;
  }
  return format == ParticleFormat::LammpsData ? parse_particles_lammps(text, path)
                                              : parse_particles_csv(text, path);
}

std::vector<BondData> read_bonds(const std::string& path, ParticleFormat format) {
  if (format == ParticleFormat::Csv) return parse_bonds_csv(read_unpacked_file(path), path);
  if (format == ParticleFormat::Vtp) return parse_bonds_vtp(read_unpacked_file(path), path);
  std::vector<BondData> all;
  for (const std::string& piece : read_pvtp(path)) {
    const std::vector<BondData> bonds = parse_bonds_vtp(read_unpacked_file(piece), piece);
    all.insert(all.end(), bonds.begin(), bonds.end());
  }
  return all;
}

std::vector<std::int64_t> sorted_ids(const ParticleFile& file) {
  std::vector<std::int64_t> ids;
  for (const ParticleData& p : file.particles) ids.push_back(p.id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// A piece of one rank lacks what lies on others: so do its bonds.
void drop_bonds_to_elsewhere(ParticleFile& file) {
  const std::vector<std::int64_t> ids = sorted_ids(file);
  const auto is_here = [&](std::int64_t id) {
    return std::binary_search(ids.begin(), ids.end(), id);
  };
  const std::size_t dropped = std::erase_if(
      file.bonds, [&](const BondData& b) { return !is_here(b.id_a) || !is_here(b.id_b); });
  if (dropped > 0)
    file.notes.push_back(fmt::format(
        "{} bonds with an end that is not in this file are left out; the .pvtp has all", dropped));
}

}  // namespace

bool is_packed(std::string_view path) {
  return lower_case(path).ends_with(kPacked);
}

std::optional<ParticleFormat> particle_format(std::string_view path) {
  const std::string name = lower_case(without_packing(path));
  if (name.ends_with(".csv") || name.ends_with(".tsv")) return ParticleFormat::Csv;
  if (name.ends_with(".data") || name.ends_with(".lmp")) return ParticleFormat::LammpsData;
  if (name.ends_with(".vtp")) return ParticleFormat::Vtp;
  if (name.ends_with(".pvtp")) return ParticleFormat::Pvtp;
  return std::nullopt;
}

std::string bonds_path(const std::string& path) {
  const std::size_t end = without_packing(path).size();
  const std::size_t dot = path.rfind('.', end - 1);
  return path.substr(0, dot) + "_bonds" + path.substr(dot);
}

ParticleFile read_particles(const std::string& path) {
  const auto format = particle_format(path);
  if (!format)
    throw InputError(SourcePlace{path, 0, 0}, "this ending names no format that is read",
                     std::string("give a file that ends in ") + kParticleEndings);
  ParticleFile file = read_alone(path, *format);
  if (*format == ParticleFormat::LammpsData) return file;
  const std::string beside = bonds_path(path);
  if (!std::filesystem::exists(beside)) return file;
  file.bonds = read_bonds(beside, *format);
  file.has_bonds = true;
  if (*format == ParticleFormat::Vtp) drop_bonds_to_elsewhere(file);
  check_bonds(file, file.bonds, beside);
  return file;
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

void check_bond_row(BondData& bond, const LineReader& lines) {
  const auto refuse = [&](const std::string& what, const char* remedy) {
    throw InputError(
        lines.place(),
        fmt::format("the bond between particles {} and {} {}", bond.id_a, bond.id_b, what), remedy);
  };
  if (bond.id_a < 1 || bond.id_b < 1) refuse("has no valid id", "ids count from 1");
  if (bond.id_a == bond.id_b) refuse("links a particle with itself", "give two ids");
  if (bond.law < 0) refuse("has no valid type", "types count the deck's bond laws from 1");
  if (!(bond.length >= 0.0) || !std::isfinite(bond.length))
    refuse("has a length below zero", "a length is above zero [m], or 0 for that at the start");
  const bool is_finite =
      bond.shear.allFinite() && bond.bending.allFinite() && std::isfinite(bond.twisting);
  if (!is_finite) refuse("has a force that is not finite", "the file is damaged");
  if (bond.id_a < bond.id_b) return;
  if (!bond.shear.isZero(0.0) || !bond.bending.isZero(0.0) || bond.twisting != 0.0)
    refuse("is not in order", "where forces are given, the lower id comes first");
  std::swap(bond.id_a, bond.id_b);
}

void check_bonds(const ParticleFile& particles, std::span<const BondData> bonds,
                 const std::string& file) {
  const std::vector<std::int64_t> ids = sorted_ids(particles);
  const auto refuse = [&](const BondData& bond, const std::string& what, const char* remedy) {
    throw InputError(
        SourcePlace{file, 0, 0},
        fmt::format("the bond between particles {} and {} {}", bond.id_a, bond.id_b, what), remedy);
  };
  std::vector<std::pair<std::int64_t, std::int64_t>> pairs;
  for (const BondData& bond : bonds) {
    for (const std::int64_t id : {bond.id_a, bond.id_b}) {
      if (!std::binary_search(ids.begin(), ids.end(), id))
        refuse(bond, fmt::format("names particle {}, which does not exist", id),
               "both ends are particles of the file");
    }
    pairs.emplace_back(bond.id_a, bond.id_b);
  }
  std::sort(pairs.begin(), pairs.end());
  const auto twin = std::adjacent_find(pairs.begin(), pairs.end());
  if (twin == pairs.end()) return;
  BondData bond;
  bond.id_a = twin->first;
  bond.id_b = twin->second;
  refuse(bond, "is listed twice", "one bond a pair");
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
