#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <barchan/comm/base/reduction.hpp>
#include <barchan/core/links/walls.hpp>

namespace barchan {

/// Motion of the walls, the same on every rank.
///
/// A given velocity moves a wall by v·dt a step. A loaded plate is a rigid body with one degree of
/// freedom s along its normal n:
///
///     mass·d²s/dt² = F·n + q·A − c·ds/dt,   A = width (2D, unit depth) or width·depth,
///
/// stepped as the particles are: leapfrog, with the force F of the particles at the same step, and
/// c on the mean of the velocities before and after. So it is second order and makes no energy.
/// F is summed over all ranks behind the work of the step:
///
///     particles and plates at step k ─► contacts with plates ─► begin(k) ── all other work of step
///     k ──► kick(k), move: plates at step k+1
class Plates {
 public:
  Plates(const Communicator& communicator, std::span<const WallSpec> specs, double dt);

  /// Whether some loaded plate is there, so that steps need begin() and kick().
  [[nodiscard]] bool are_driven(std::span<const WallState> states) const;
  /// Whether no wall moves, nor will.
  [[nodiscard]] bool stand_still(std::span<const WallState> states) const;
  /// For begin(): zeros, one a wall. Reuses memory.
  [[nodiscard]] std::span<WallSums> start_sums();
  /// Before the rest of a step: forces of this rank's particles on the walls. Collective; waits for
  /// nobody.
  void begin(std::span<const WallSums> sums);
  /// After it, where plates are driven: loaded plates take up their forces. Waits for the sum.
  /// @param appears_in  the stage that begins with this step, or -1: plates that appear start with
  /// half a kick, as particles do
  /// @param works  of each wall on the particles in this step; those of loaded plates are added
  /// [J]; empty: another rank counts them
  void kick(std::span<WallState> states, int appears_in, std::span<WallSums> works);
  /// The step before, and the one under way, which begin() to move() are of [s].
  void set_steps(double last_dt, double dt) {
    last_dt_ = last_dt;
    dt_ = dt;
  }
  /// After that all walls move.
  void move(std::span<WallState> states) const;
  void set_load(std::size_t wall, double load) { specs_[wall].load = load; }
  void set_normal(std::size_t wall, const Vec3& normal) { specs_[wall].normal = normal; }
  [[nodiscard]] double load(std::size_t wall) const { return specs_[wall].load; }
  [[nodiscard]] double wait_seconds() const { return wait_seconds_; }  ///< for sums of forces

 private:
  [[nodiscard]] Vec3 force_on(std::size_t plate) const;

  std::vector<WallSpec> specs_;
  std::vector<WallSums> sums_;
  std::vector<std::size_t> loaded_;
  double last_dt_, dt_;
  double wait_seconds_ = 0.0;
  std::vector<std::int64_t> digits_;
  std::unique_ptr<Reduction> reduction_;  ///< null: no plate is loaded
};

}  // namespace barchan
