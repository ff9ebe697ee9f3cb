#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <barchan/core/base/error.hpp>
#include <barchan/core/base/vec.hpp>
#include <barchan/core/laws/laws.hpp>
#include <barchan/core/model/source_record.hpp>

// The contents of a deck, checked and in SI, for 2D and 3D alike (2D leaves z at zero).
// Plain data: the deck reader writes it, generators and the simulation read it.

namespace barchan {

/// What happens to a particle that leaves the domain along an axis that is not periodic.
enum class OutsidePolicy { Error, Delete };

/// How ranks are cut: in the way with the smallest predicted step, into strips, or into bricks,
/// a number along each axis.
struct CutWish {
  static constexpr int kMost = 1 << 20;  ///< bricks along an axis
  enum class Kind { Auto, Strips, Bricks };
  Kind kind = Kind::Auto;
  std::array<int, 3> bricks{1, 1, 1};  ///< along x, y and z
  SourcePlace place{};                 ///< in the deck, if it comes from one
};

/// Box that bounds the particles; periodic axes wrap.
struct Domain {
  Vec3 lo = Vec3::Zero();  ///< [m]
  Vec3 hi = Vec3::Zero();  ///< [m]
  std::array<bool, 3> periodic{};
  int strip_axis = 0;  ///< axis along which ranks cut strips
  CutWish cuts{};
  OutsidePolicy outside = OutsidePolicy::Error;
  SourcePlace place{};  ///< in the deck, if it comes from one
};

struct Material {
  std::string name;
  double density = 0.0;        ///< [kg/m³]; in 2D areal, [kg/m²] for unit thickness
  double conductivity = 0.0;   ///< [W/(m·K)]; 0: not given
  double heat_capacity = 0.0;  ///< [J/(kg·K)]; 0: not given
};

/// Whether particles have temperatures, and that of the start.
struct HeatSpec {
  bool is_on = false;
  double temperature = 293.15;  ///< [K], of particles that say nothing else
  bool dissipation = false;     ///< what contacts lose warms their particles
};

/// Contact constants of every pair of materials: entry (a, b) = (b, a) = constants[a·n + b].
struct ContactTable {
  int num_materials = 0;
  std::vector<ContactConstants> constants;
  bool no_tension = true;  ///< clamp the normal force at zero while particles part
  int law = 0;             ///< place in the list of laws
  Tangential tangential = Tangential::Mindlin;  ///< read by Hertz contacts
  /// Of an impact that the stable step allows for [m/s]; none: as fast as the start and falls make
  /// it.
  std::optional<double> reference_speed = std::nullopt;

  bool twisting = false;               ///< read by contacts that roll
  Adhesion adhesion = Adhesion::None;  ///< read by contacts that stick
  PullOff pull_off = PullOff::Limit;   ///< read by JKR contacts

  [[nodiscard]] ContactRules rules() const {
    return {no_tension, tangential, twisting, adhesion, pull_off};
  }

  [[nodiscard]] const ContactConstants& at(int a, int b) const {
    return constants[static_cast<std::size_t>(a) * static_cast<std::size_t>(num_materials) +
                     static_cast<std::size_t>(b)];
  }
};

/// Bond (linking element) after Potyondy & Cundall 2004, doi:10.1016/j.ijrmms.2004.09.011.
/// Section: 2D a rectangle of height 2·radius_factor·min(r_i, r_j) and unit depth; 3D a disk of
/// that radius.
struct BondLaw {
  std::string name;
  double young_modulus = 0.0;    ///< E [Pa]: axial stiffness E·A/L, bending stiffness E·I/L
  double stiffness_ratio = 2.5;  ///< normal over shear stiffness per area; twisting uses shear
  double radius_factor = 1.0;    ///< section radius over the smaller particle radius
  double damping_ratio = 0.0;    ///< of critical, on the relative motion of the two ends
  /// Per section area [Pa/m]; when > 0 it stands for young_modulus / L.
  double normal_stiffness = 0.0;
  double tensile_strength = std::numeric_limits<double>::infinity();  ///< [Pa]
  double shear_strength = std::numeric_limits<double>::infinity();    ///< [Pa]
};

enum class WallKind { Plane, Plate };

/// A plane fills the half-space behind its normal. A plate is a flat face of finite width around
/// `point` (2D a segment, 3D a rectangle), touched at its nearest point from either side.
struct WallSpec {
  std::string name;
  WallKind kind = WallKind::Plane;
  int material = 0;
  Vec3 point = Vec3::Zero();     ///< [m]
  Vec3 normal = Vec3::Zero();    ///< unit, towards the particles
  Vec3 velocity = Vec3::Zero();  ///< [m/s], given; for a loaded plate its start
  double width = 0.0;      ///< plate: along the in-plane axis [m] (2D perpendicular to normal)
  double depth = 0.0;      ///< plate in 3D: the other in-plane extent [m]
  bool is_loaded = false;  ///< plate moved along its normal by load, contact forces and damping
  double load = 0.0;  ///< service load q along the normal, towards the particles [N/m²] (2D: [N/m]
                      ///< of width per unit depth)
  double mass = 0.0;  ///< of a loaded plate [kg]
  double damping = 0.0;  ///< viscous, on a loaded plate [N·s/m]
  int from_stage = 0;    ///< absent before this stage
  SourcePlace place;     ///< in the deck, if it comes from one
  // Where heat is on; at most one of the two. Neither: no heat goes through it.
  std::optional<double> temperature = std::nullopt;  ///< kept [K]
  std::optional<double> heat_flux = std::nullopt;    ///< into what touches it [W/m²]
  [[nodiscard]] bool gives_heat() const { return temperature || heat_flux; }
};

/// A stage of the run; it ends after a time or when the kinetic-energy ratio is low enough.
struct Stage {
  std::string name;
  /// Cundall's alpha: force reduced by alpha·|F|·sign(v), per component.
  double local_damping = 0.0;
  double max_time = std::numeric_limits<double>::infinity();  ///< length of the stage [s]
  double kinetic_ratio = 0.0;  ///< end when kinetic over elastic energy falls below; 0 = never
};

struct TimeSpec {
  double step = 0.0;           ///< dt [s]
  std::int64_t num_steps = 0;  ///< of the whole run
  bool allow_unstable = false;
  SourcePlace place{};  ///< of the step in the deck, if it comes from one
};

enum class ContactSearchKind { Cells, AllPairs };

struct SearchSpec {
  ContactSearchKind kind = ContactSearchKind::Cells;
  std::optional<double> skin;  ///< [m]; none = the default (tasks/stability.hpp)
};

/// How ranks exchange halos. No bit of the state depends on it.
struct ExchangeSpec {
  int depth = 0;        ///< slabs beyond each cut that a rank steps, too
  SourcePlace place{};  ///< of it in the deck, if it comes from one
};
inline constexpr int kMostDepth = 64;

/// Overlaps beyond which a run warns or ends, as shares of the smaller radius; infinite: never.
struct LimitSpec {
  double overlap_warning = 0.5;
  double overlap_error = 1.0;
};

struct OutputSpec {
  std::int64_t series_every = 0;     ///< steps; 0 = a hundredth of the run
  std::int64_t snapshots_every = 0;  ///< steps; 0 = only first and last
  bool picture = true;               ///< final state as picture.png
  bool energy = false;               ///< keep an account of where energy goes
};

struct CheckpointSpec {
  std::int64_t every_steps = 0;  ///< 0 = not by steps
  double every_seconds = 0.0;    ///< of wall-clock time; 0 = not by time
  int keep = 2;                  ///< number of checkpoints to keep, the newest ones
};

/// One particle of a file or generator, dimension-free (2D: z = vz = omegax = omegay = 0).
struct ParticleData {
  std::int64_t id = 0;    ///< from 1
  std::int32_t type = 0;  ///< material index, from 0
  double radius = 0.0;    ///< [m]
  double density = 0.0;   ///< [kg/m³], 2D areal [kg/m²]
  Vec3 position = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  Vec3 omega = Vec3::Zero();  ///< [rad/s]
  bool fixed = false;         ///< never moves: inverse mass and inertia are zero
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< [K]; none: not a number
};

/// An intact bond between two particles, dimension-free; straight and unstressed unless it says
/// otherwise.
struct BondData {
  std::int64_t id_a = 0;  ///< lower id
  std::int64_t id_b = 0;
  std::int32_t law = 0;         ///< index into Model::bond_laws
  double length = 0.0;          ///< unstressed [m]; 0: the distance at the start
  Vec3 shear = Vec3::Zero();    ///< force [N]; in 2D x: along the normal a → b turned left
  Vec3 bending = Vec3::Zero();  ///< moment [N·m]; in 2D z
  double twisting = 0.0;        ///< moment [N·m], in 3D
};

struct ParticleSet {
  std::vector<ParticleData> particles;
  std::vector<BondData> bonds;
  std::vector<std::string> notes{};  ///< what a user should know of the files, a line each
};

struct Model {
  std::string title;
  std::string deck_file;
  int dimension = 2;
  Domain domain;
  TimeSpec time;
  Vec3 gravity = Vec3::Zero();  ///< [m/s²]
  std::vector<Material> materials;
  ContactTable contacts;
  std::vector<BondLaw> bond_laws;
  std::vector<WallSpec> walls;
  std::vector<Stage> stages;  ///< never empty
  HeatSpec heat;
  SearchSpec search;
  ExchangeSpec exchange;
  LimitSpec limits;
  OutputSpec output;
  CheckpointSpec checkpoint;
  std::vector<SourceRecord> sources;  ///< what a restart holds its particles against; may be empty
};

}  // namespace barchan
