#pragma once

#include <cstddef>

#include <barchan/core/base/vec.hpp>
#include <barchan/core/links/walls.hpp>

namespace barchan {

class Simulation;

/// A wall of a simulation, which lives longer and is not moved.
class WallControl {
 public:
  [[nodiscard]] const WallState& state() const;  ///< force, torque and work of the last measure()
  [[nodiscard]] const Vec3& normal() const;      ///< unit
  /// From the next step on [m/s]. Collective; the same on every rank.
  /// Errors: InputError: the wall is moved by its load
  void set_velocity(const Vec3& velocity);
  /// Of a loaded plate, along its normal [N/m²]. Collective; the same on every rank.
  /// Errors: InputError: the wall is not loaded
  void set_load(double load);
  /// Puts it elsewhere at once, without a velocity; contacts keep their springs. Collective; the
  /// same on every rank.
  /// @param point   of the wall [m]
  /// @param normal  of any length
  /// Errors: InputError, and nothing is changed: a particle would reach into the wall by more than
  /// half of its radius, a normal of length 0, or one that this domain cannot have
  void set_pose(const Vec3& point, const Vec3& normal);
  void set_pose(const Vec3& point);  ///< the same, with its normal as it is

 private:
  friend class Simulation;
  WallControl(Simulation& simulation, std::size_t wall) : simulation_(&simulation), wall_(wall) {}
  Simulation* simulation_;
  std::size_t wall_;
};

}  // namespace barchan
