#pragma once

#include <array>
#include <memory>
#include <vector>

#include <barchan/comm/reduction.hpp>
#include <barchan/core/checkpoint/state.hpp>
#include <barchan/core/walls.hpp>

namespace barchan {

/// Motion of the walls, the same on every rank.
///
/// A given velocity moves a wall by v·dt a step. A loaded plate is a rigid body with one degree of
/// freedom s along its normal n:   mass·ds²/dt² = F·n − q·A − c·ds/dt,   A = width (2D, unit depth)
/// or width·depth. F, the force of the particles on it, is summed over all ranks behind the next
/// step and used kLag steps late on any number of ranks: the reduction is hidden, and the bits are
/// the same. The lag takes kLag·dt·k off the damping of a plate on stiffness k, so a plate is given
/// mass enough that this does not matter (see `barchan check`).
class Plates {
 public:
  static constexpr int kLag = 2;

  Plates(const Communicator& communicator, std::span<const WallSpec> specs, double dt);

  [[nodiscard]] bool needs_forces(std::span<const WallState> states) const;
  /// Before a step: plate velocities from the forces of kLag steps ago.
  void drive(std::span<WallState> states, std::int64_t step);
  /// After a step: its wall sums, this rank's share. Starts their reduction.
  void collect(std::span<const WallSums> sums, std::int64_t step);
  /// After a step: walls move.
  void move(std::span<WallState> states) const;
  /// Forces that steps are still to use, by step % kLag; for checkpoints, between steps. Waits for
  /// what is in flight.
  [[nodiscard]] std::vector<SavedPlateForces> forces();
  /// Puts them back into flight. Collective. Errors: RunError when they are not of as many plates.
  void restore(std::span<const SavedPlateForces> forces, bool is_root);
  [[nodiscard]] double wait_seconds() const { return wait_seconds_; }  ///< for forces

 private:
  void accelerate(WallState& state, const WallSpec& spec, const Vec3& force) const;

  std::vector<WallSpec> specs_;
  std::vector<std::size_t> loaded_;
  double dt_;
  double wait_seconds_ = 0.0;
  std::array<std::unique_ptr<Reduction>, kLag> reductions_;
  std::array<std::int64_t, kLag> of_step_{};
};

}  // namespace barchan
