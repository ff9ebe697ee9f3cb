#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/core/model.hpp>
#include <barchan/core/particle_source.hpp>

namespace barchan {

class LineReader;

/// What a file of particles holds. Types count from 0 here and from 1 in every file.
struct ParticleFile {
  std::string file;
  std::vector<ParticleData> particles;  ///< in the order of the file
  std::vector<std::int64_t> lines;      ///< line of each particle in the file
  std::optional<Box> box;               ///< given by LAMMPS data files

  /// The densities are those of spheres even if the particles are disks: mass = 4/3·pi·r³·density.
  /// LAMMPS means this in 2D as well; LIGGGHTS and CSV mean areal densities there.
  bool has_sphere_density = false;
};

/// Reads by the name's ending: `.data` or `.lmp` LAMMPS, `.vtp` or `.pvtp` snapshot, else CSV.
/// @throws InputError
[[nodiscard]] ParticleFile read_particles(const std::string& path);

/// Reads a table with a header: `id,type,radius,density,x,y,z,vx,vy,vz,omegax,omegay,omegaz` in any
/// order. z, velocities and angular velocities may be absent (zero); other columns, blank lines and
/// lines that begin with # are ignored.
/// @throws InputError with file, line and column: malformed or non-finite number, missing or
///         repeated column, too few or too many fields, id or type below 1, repeated id, radius or
///         density not positive, no particles
[[nodiscard]] ParticleFile read_particles_csv(const std::string& path);
[[nodiscard]] ParticleFile parse_particles_csv(std::string_view text, const std::string& file);

/// Reads a LAMMPS data file of atom style sphere (LIGGGHTS: granular): header with box, `Atoms`
/// with `id type diameter density x y z` and optional image flags, `Velocities` with `id vx vy vz
/// wx wy wz`.
/// @throws InputError as for CSV, and for counts that disagree, tilted boxes and sections it does
/// not know
[[nodiscard]] ParticleFile read_particles_lammps(const std::string& path);
[[nodiscard]] ParticleFile parse_particles_lammps(std::string_view text, const std::string& file);

/// Reads a snapshot piece `.vtp`, or all pieces of a `.pvtp`, with arrays id, type, radius,
/// density, velocity and angular_velocity. Lines are zero. @throws InputError
[[nodiscard]] ParticleFile read_particles_vtp(const std::string& path);
/// The same from the text of one piece.
[[nodiscard]] ParticleFile parse_particles_vtp(std::string_view text, const std::string& file);

/// Gives disks the areal density that keeps their mass: density·4/3·r. Does nothing to areal
/// densities.
void convert_to_areal_density(ParticleFile& file);

/// Writes every column with 17 digits, so that reading gives the same bits. @throws RunError
void write_particles_csv(const std::string& path, std::span<const ParticleData> particles);

/// Writes a LAMMPS data file; in 2D densities become those of spheres and the box gets a thickness
/// around z = 0.
/// @throws RunError
void write_particles_lammps(const std::string& path, std::span<const ParticleData> particles,
                            const Box& box, int dimension);

/// Writes one piece that read_particles_vtp, ParaView and OVITO read. @throws RunError
void write_particles_vtp(const std::string& path, std::span<const ParticleData> particles);

/// Checks that every reader makes: at least one particle, ids from 1 and unique. @throws InputError
/// with a line
void check_particle_file(const ParticleFile& file);

/// Checks one particle just read. @throws InputError at the line last read
void check_particle_row(const ParticleData& particle, const LineReader& lines);

}  // namespace barchan
