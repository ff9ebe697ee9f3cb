#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <barchan/core/base/error.hpp>
#include <barchan/core/model/model.hpp>

// Where the particles of a run come from: plain data that a deck writes and the generators read.
// Everything is checked and in SI: indices are valid, lengths are positive and finite, boxes are
// not empty.

namespace barchan {

/// Particles with centres in lo <= x <= hi, per axis; 2D leaves z at zero (lo.z = hi.z = 0), where
/// it is not compared.
struct Box {
  Vec3 lo = Vec3::Zero();  ///< [m]
  Vec3 hi = Vec3::Zero();  ///< [m]
};

/// Radii uniform in [min, max]; a single radius has min = max.
struct RadiusClass {
  double min = 0.0;     ///< [m] > 0
  double max = 0.0;     ///< [m] >= min
  double weight = 1.0;  ///< share by number, > 0, not normalised
};

/// The sizes that a generator draws from; never empty.
struct SizeDistribution {
  std::vector<RadiusClass> classes;

  [[nodiscard]] double min_radius() const;  ///< [m]
  [[nodiscard]] double max_radius() const;  ///< [m]
};

/// A disk (2D) or sphere (3D) that a packing keeps free: no particle of the packing reaches into
/// it.
struct Hole {
  Vec3 center = Vec3::Zero();  ///< [m]
  double radius = 0.0;         ///< [m] > 0
};

/// A file that read_particles knows by its ending. Types count materials from 1 in deck order
/// unless ParticleSource::material is given; bonds of the file are linked as they are, and their
/// types count bond laws unless ParticleSource::bond is given.
struct FileSource {
  /// As opened: a relative path of the deck is already joined to the deck's folder.
  std::string path;
  /// LAMMPS data in 2D: mass = 4/3·pi·r³·density, not pi·r²·density.
  bool has_sphere_density = true;
};

/// Particles on a regular grid whose first site lies at region.lo + spacing/2 on every axis.
/// Every particle stays within the region; z is zero in 2D.
struct LatticeSource {
  /// Square and Hexagonal are 2D (rows along x), Cubic and Fcc are 3D (spacing is the nearest
  /// distance).
  enum class Arrangement { Square, Hexagonal, Cubic, Fcc } arrangement = Arrangement::Square;
  Box region;
  SizeDistribution sizes;
  double spacing = 0.0;  ///< between nearest sites [m], at least 2·max_radius
  double jitter = 0.0;   ///< share of the free gap in [0, 1]: a shift in any direction of a length
                         ///< up to jitter·(spacing/2 - radius), so neighbours never overlap
  std::uint64_t seed = 1;  ///< of radii and jitter
};

/// Random close packing; exactly one of count and solid_fraction is given.
struct PackingSource {
  Box region;
  SizeDistribution sizes;
  std::optional<std::int64_t> count;  ///< particles, > 0
  /// Area (2D) or volume (3D) of particles over the region less its holes.
  std::optional<double> solid_fraction;
  std::vector<Hole> holes;
  std::uint64_t seed = 1;
};

/// Disks evenly spaced on a circle (2D), counter-clockwise from `start_angle`.
struct RingSource {
  Vec3 center = Vec3::Zero();  ///< [m]
  double radius = 0.0;         ///< centre to disk centres [m]
  std::int64_t count = 0;      ///< disks, >= 3
  /// [m]; the deck fills in radius·sin(pi/count), where neighbours just touch.
  double disk_radius = 0.0;
  double start_angle = 0.0;  ///< of the first disk from the x axis [rad]
};

/// Particles written out one by one. `type`, `density` and `velocity` are filled in from the
/// source's; ids are zero.
struct ListSource {
  std::vector<ParticleData> particles;
  std::vector<SourcePlace> places{};  ///< of each in the deck; empty: not from one
};

/// Which particles ParticleSource::bond links: those that touch, unless one of these is given.
struct BondLinks {
  SourcePlace place;          ///< of the bond in the deck, or of what says it otherwise
  std::optional<double> gap;  ///< between surfaces up to which two are linked [m]
  std::vector<std::pair<std::int64_t, std::int64_t>> pairs;  ///< exactly these ids
};

/// One [[particles]] table. Sources follow each other in deck order, and so do the ids of their
/// particles.
struct ParticleSource {
  SourcePlace place;              ///< of the table in the deck, for errors found while generating
  SourceRecord record;            ///< what the table says, for checkpoints
  std::optional<int> material;    ///< index; none only for a file that brings its own types
  std::optional<double> density;  ///< instead of the material's (or the file's), 2D areal
  Vec3 velocity = Vec3::Zero();   ///< [m/s]; a file's own velocities are added to it
  Vec3 omega = Vec3::Zero();      ///< [rad/s]; a file's own are added to it
  std::optional<double> temperature;  ///< [K], instead of the deck's or the file's
  std::optional<int> bond;  ///< index into Model::bond_laws: bonds those of this source that touch
      ///< (ring: the neighbours along it; touch: gap <= 1e-6 of the radii's sum), see BondLinks
  BondLinks links;
  std::optional<Box> fixed;  ///< particles with centres in here never move; endless box = all
  std::variant<FileSource, LatticeSource, PackingSource, RingSource, ListSource> kind;
};

}  // namespace barchan
