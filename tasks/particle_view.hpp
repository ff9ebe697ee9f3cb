#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <barchan/core/base/vec.hpp>

namespace barchan {

/// Numbers of many particles where barchan has them: `width` of each, `stride` numbers apart.
///
///     data ─► | x  y  z | …  | x  y  z | …
///             |<-- stride -->|
template <class T>
class StridedSpan {
 public:
  StridedSpan() = default;
  StridedSpan(T* data, std::size_t size, int width, std::ptrdiff_t stride)
      : data_(data), size_(size), width_(width), stride_(stride) {}

  [[nodiscard]] std::size_t size() const { return size_; }  ///< particles
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }  ///< in numbers
  [[nodiscard]] T* data() const { return data_; }
  /// The numbers of a particle.
  [[nodiscard]] T* operator[](std::size_t i) const {
    return data_ + static_cast<std::ptrdiff_t>(i) * stride_;
  }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
  int width_ = 1;
  std::ptrdiff_t stride_ = 1;
};

/// What views throw after rows have moved, and after their simulation is gone.
class StaleView : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Counts how often arrays of a simulation have moved; views look whether theirs still stand.
class Generation {
 public:
  [[nodiscard]] std::uint64_t value() const { return *value_; }
  [[nodiscard]] bool is_of(const Generation& other) const { return value_ == other.value_; }
  void advance() { ++*value_; }
  void end() { *value_ = kGone; }  ///< the simulation is gone
  /// Errors: StaleView, when arrays have moved since then.
  void require(std::uint64_t then, const char* what) const;

 private:
  static constexpr std::uint64_t kGone = std::numeric_limits<std::uint64_t>::max();
  std::shared_ptr<std::uint64_t> value_ = std::make_shared<std::uint64_t>(0);
};

/// The arrays of a brick, as they stand.
struct BrickArrays {
  std::span<const std::int64_t> ids;
  StridedSpan<const double> positions;       ///< [m]; 2 in 2D, else 3
  StridedSpan<const double> velocities;      ///< half a step behind positions [m/s]
  StridedSpan<const double> surface_speeds;  ///< radius · angular velocity [m/s]; 1 in 2D, else 3
  StridedSpan<const double> radii;           ///< [m]
  StridedSpan<const double> inverse_masses;  ///< of a fixed particle 0 [1/kg]
  std::span<const double> densities;         ///< [kg/m³], 2D [kg/m²]
  std::span<const std::uint8_t> types;
};

class LoadView;

/// Where a view finds what may be written; the inside of a simulation.
class BrickSource {
 public:
  virtual ~BrickSource() = default;
  virtual LoadView loads_of(int brick) = 0;
  virtual StridedSpan<double> field_of(int brick, const std::string& name) = 0;
};

/// Particles of one brick of this rank, in the memory that the steps work on. Each call looks
/// whether the rows still stand, and throws StaleView where they do not: so ask for a span once,
/// and then go over it. Within one generation, spans show the newest values after every run().
class ParticleView {
 public:
  ParticleView(const BrickArrays& arrays, Generation generation, BrickSource& source, int brick)
      : arrays_(arrays),
        generation_(std::move(generation)),
        then_(generation_.value()),
        source_(&source),
        brick_(brick) {}

  [[nodiscard]] std::size_t size() const { return fresh().ids.size(); }
  [[nodiscard]] std::span<const std::int64_t> ids() const { return fresh().ids; }
  [[nodiscard]] StridedSpan<const double> positions() const { return fresh().positions; }
  [[nodiscard]] StridedSpan<const double> velocities() const { return fresh().velocities; }
  [[nodiscard]] StridedSpan<const double> surface_speeds() const { return fresh().surface_speeds; }
  [[nodiscard]] StridedSpan<const double> radii() const { return fresh().radii; }
  [[nodiscard]] StridedSpan<const double> inverse_masses() const { return fresh().inverse_masses; }
  [[nodiscard]] std::span<const double> densities() const { return fresh().densities; }
  [[nodiscard]] std::span<const std::uint8_t> types() const { return fresh().types; }
  /// [rad/s]; in 2D about z. Computed.
  [[nodiscard]] Vec3 angular_velocity(std::size_t i) const;
  [[nodiscard]] double mass(std::size_t i) const;  ///< of a fixed particle infinite [kg]. Computed.
  [[nodiscard]] std::uint64_t generation() const { return then_; }
  [[nodiscard]] int brick() const { return brick_; }  ///< of this rank, from 0
  /// The loads on them, to be written in place.
  [[nodiscard]] LoadView loads() const;
  /// A field of the caller's own, to be read and written in place.
  /// Errors: std::invalid_argument: there is no such field
  [[nodiscard]] StridedSpan<double> field(const std::string& name) const;

 private:
  [[nodiscard]] const BrickArrays& fresh() const {
    generation_.require(then_, "particles");
    return arrays_;
  }

  BrickArrays arrays_;
  Generation generation_;
  std::uint64_t then_;
  BrickSource* source_;
  int brick_;
};

/// The loads on the particles of one brick, to be written in place; row i belongs to row i of the
/// ParticleView. They stay, and travel with their particles, until they are written again.
class LoadView {
 public:
  LoadView(StridedSpan<double> forces, StridedSpan<double> torques_by_radius,
           StridedSpan<const double> radii, Generation generation)
      : forces_(forces),
        torques_by_radius_(torques_by_radius),
        radii_(radii),
        generation_(std::move(generation)),
        then_(generation_.value()) {}

  [[nodiscard]] std::size_t size() const { return fresh().forces_.size(); }
  [[nodiscard]] StridedSpan<double> forces() const { return fresh().forces_; }  ///< [N]
  /// Torque / radius [N]; 1 in 2D, else 3.
  [[nodiscard]] StridedSpan<double> torques_by_radius() const { return fresh().torques_by_radius_; }
  /// @param torque  about the particle's centre [N·m]; in 2D only z counts
  void set(std::size_t i, const Vec3& force, const Vec3& torque = Vec3::Zero()) const;

 private:
  [[nodiscard]] const LoadView& fresh() const {
    generation_.require(then_, "loads");
    return *this;
  }

  StridedSpan<double> forces_, torques_by_radius_;
  StridedSpan<const double> radii_;
  Generation generation_;
  std::uint64_t then_;
};

/// A field of the caller's own (Simulation::add_field) of the particles of one brick, to be read
/// and written in place; row i belongs to row i of the ParticleView.
class FieldView {
 public:
  FieldView(StridedSpan<double> values, Generation generation)
      : values_(values), generation_(std::move(generation)), then_(generation_.value()) {}

  [[nodiscard]] std::size_t size() const { return values().size(); }
  [[nodiscard]] StridedSpan<double> values() const {
    generation_.require(then_, "a field");
    return values_;
  }

 private:
  StridedSpan<double> values_;
  Generation generation_;
  std::uint64_t then_;
};

/// Loads on some particles.
struct Loads {
  std::span<const std::int64_t> ids;
  std::span<const double> forces;   ///< three a particle, in 2D too [N]
  std::span<const double> torques;  ///< about the centre, three a particle [N·m]; none: zeros
};

/// What gather() and scatter() move.
enum class ParticleField {
  Position,         ///< [m]
  Velocity,         ///< half a step behind positions [m/s]
  AngularVelocity,  ///< [rad/s]
  Force,            ///< of the caller, as loads [N]
  Torque,           ///< of the caller [N·m]
  Radius,           ///< [m]
  Mass,             ///< of a fixed particle infinite [kg]
  Type,             ///< index of its material
  Temperature,      ///< where the model has heat [K]
};

/// Numbers of a particle: 3 for vectors, in 2D too, else 1.
[[nodiscard]] int width_of(ParticleField field);

/// Values of all particles, in order of their ids.
struct Gathered {
  std::vector<std::int64_t> ids;
  std::vector<double> values;  ///< width_of(field) each, or as many as a field has components
};

}  // namespace barchan
