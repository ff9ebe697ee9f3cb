#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/core/model/model.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan {

class LineReader;

enum class ParticleFormat { Csv, LammpsData, Vtp, Pvtp };

/// By the name's ending, in any case, `.gz` or not; none for others. `.csv`, `.tsv`; `.data` and
/// `.lmp` are LAMMPS data; `.vtp` and `.pvtp` snapshots.
[[nodiscard]] std::optional<ParticleFormat> particle_format(std::string_view path);

/// Does the name end in `.gz`?
[[nodiscard]] bool is_packed(std::string_view path);

/// The endings, for messages.
inline constexpr const char* kParticleEndings =
    ".csv or .tsv (a table with a header), .data or .lmp (LAMMPS data), .vtp or .pvtp (a "
    "snapshot), "
    "each also packed as .gz";

/// What a file of particles holds. Types, and laws of bonds, count from 0 here and from 1 in every
/// file.
struct ParticleFile {
  std::string file;
  std::vector<ParticleData> particles;  ///< in the order of the file
  std::vector<std::int64_t> lines;      ///< line of each particle in the file
  std::optional<Box> box;               ///< given by LAMMPS data files

  bool has_bonds = false;  ///< the file says which bonds there are, if only that there are none
  std::vector<BondData> bonds;  ///< lower id first, each pair once

  /// The densities are those of spheres even if the particles are disks: mass = 4/3·pi·r³·density,
  /// as LAMMPS means them in 2D, too. All other files give areal densities there.
  bool has_sphere_density = false;

  std::vector<std::string> notes;  ///< what was not used, a line each, without the file's name
};

/// Reads a file by its ending, and its bonds: those in LAMMPS data, else those in the file beside
/// it that bonds_path names, if there is one.
/// @throws InputError, also for an unknown ending
[[nodiscard]] ParticleFile read_particles(const std::string& path);

/// The file beside a table or snapshot that holds its bonds: `x_bonds.csv` for `x.csv`.
[[nodiscard]] std::string bonds_path(const std::string& path);

/// Reads a table with a header: `id,type,radius,density,x,y,z,vx,vy,vz,omegax,omegay,omegaz` in any
/// order, by the names of column_names.hpp, `diameter` in place of `radius`. z, velocities and
/// angular velocities may be absent (zero); other columns are listed in the notes.
/// @throws InputError with file, line and column: malformed or non-finite number, missing or
/// repeated column, a name that comes close to one of these or has a unit, too few or too many
/// fields, id or type below 1, repeated id, radius or density not positive, no particles
[[nodiscard]] ParticleFile parse_particles_csv(std::string_view text, const std::string& file);

/// Reads a LAMMPS data file of atom style sphere (LIGGGHTS: granular) or bpm/sphere: header with
/// box, `Atoms`, `Velocities`, `Bonds`; other sections are listed in the notes.
/// @throws InputError as for CSV, and for counts that disagree, tilted boxes, other atom styles and
/// sections it does not know
[[nodiscard]] ParticleFile parse_particles_lammps(std::string_view text, const std::string& file);

/// Reads one piece of a snapshot, with arrays id, type, radius, density, velocity and
/// angular_velocity; it may be empty, and ids are not compared. Lines are zero. @throws InputError
[[nodiscard]] ParticleFile parse_particles_vtp(std::string_view text, const std::string& file);

/// Bonds of a file beside the particles: a table `id_a,id_b,type,length,shear_x, …`, of which all
/// but the ids may be absent, or a piece of lines. @throws InputError
[[nodiscard]] std::vector<BondData> parse_bonds_csv(std::string_view text, const std::string& file);
[[nodiscard]] std::vector<BondData> parse_bonds_vtp(std::string_view text, const std::string& file);

/// Gives disks the areal density that keeps their mass: density·4/3·r. Does nothing to areal
/// densities.
void convert_to_areal_density(ParticleFile& file);

/// Each writes every number with 17 digits, so that reading gives the same bits. @throws RunError
void write_particles_csv(const std::string& path, std::span<const ParticleData> particles);
void write_bonds_csv(const std::string& path, std::span<const BondData> bonds);

/// What a LAMMPS data file says beyond the particles.
struct LammpsSpec {
  Box box;
  int dimension = 3;
  bool has_sphere_density = true;  ///< in 2D: densities become those of spheres of the same mass
  bool has_bonds = false;          ///< writes atom style bpm/sphere and the bonds, else sphere
};

/// Writes a LAMMPS data file; in 2D the box gets a thickness around z = 0. Lengths and forces of
/// bonds stand in comments. @throws RunError
void write_particles_lammps(const std::string& path, std::span<const ParticleData> particles,
                            std::span<const BondData> bonds, const LammpsSpec& spec);

/// Writes one piece that read_particles, ParaView and OVITO read. @throws RunError
void write_particles_vtp(const std::string& path, std::span<const ParticleData> particles);
/// Writes one piece with a line for every bond, straight from a to b, also where they are bonded
/// across a periodic face.
/// @pre both ends are among the particles. @throws RunError
void write_bonds_vtp(const std::string& path, std::span<const ParticleData> particles,
                     std::span<const BondData> bonds);

/// Checks that every reader makes: at least one particle, ids from 1 and unique. @throws InputError
/// with a line
void check_particle_file(const ParticleFile& file);

/// Checks one particle just read. @throws InputError at the line last read
void check_particle_row(const ParticleData& particle, const LineReader& lines);

/// Checks one bond just read, and puts its lower id first. @throws InputError at the line last read
void check_bond_row(BondData& bond, const LineReader& lines);

/// Checks that both ends of every bond are there and that no pair is bonded twice.
/// @throws InputError naming `file`
void check_bonds(const ParticleFile& particles, std::span<const BondData> bonds,
                 const std::string& file);

}  // namespace barchan
