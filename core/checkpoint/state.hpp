#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <barchan/core/brick/departure.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/core/particles/caller_fields.hpp>

namespace barchan {

/// A wall as a checkpoint keeps it.
struct SavedWall {
  double point[3], velocity[3];
  double force[3], torque[3], work;  ///< as last measured
  double is_active;
};

/// A look at the whole domain that is begun and not answered yet, the same on every rank.
struct PendingLook {
  std::int64_t step = -1;    ///< -1: there is none
  std::int64_t outside = 0;  ///< id of a particle
  double overlap = 0.0;      ///< share of the smaller radius
};

/// A time that steps are counted from: since then all are of one length.
struct TimePoint {
  double time = 0.0;      ///< [s]
  std::int64_t step = 0;  ///< that begins then
  [[nodiscard]] double at(std::int64_t later, double dt) const {
    return time + static_cast<double>(later - step) * dt;
  }
};

/// What a checkpoint keeps beside particles, contacts and bonds; the same on all ranks.
struct CheckpointState {
  std::int64_t step = 0, stage_begin = 0;
  std::int32_t stage = 0;

  // What the particles of the start determined, and all lists with it.
  double skin = 0.0, reach = 0.0;  ///< [m]
  double grain = 1.0;              ///< of forces [N]
  double heat_grain = 1.0;         ///< of heat flows [W]
  double overlap_limit = 1.0;      ///< limits.overlap_error, which the grain follows from
  std::int64_t start_particles = 0;
  bool has_bonds = false;
  std::int64_t num_particles = 0;  ///< now

  PendingLook look;
  double seen_overlap = 0.0;  ///< measured since the last look, for the next: share as there
  LeftDomain left;
  /// Where steps have not been of one length; last_dt = 0: they have.
  TimePoint since, stage_since;
  double last_dt = 0.0;  ///< of the step before [s]
  std::vector<SavedWall> walls;
  std::vector<CallerField::Saved> fields;  ///< of the caller's own
  std::vector<std::uint64_t> fingerprint;  ///< of the model, see below
};

/// Numbers of a particle in fields of the caller's own.
[[nodiscard]] int num_carried(const CheckpointState& state);

[[nodiscard]] std::vector<std::byte> encode(const CheckpointState& state);
/// Errors: InputError naming `file`, for bytes that make no state.
[[nodiscard]] CheckpointState decode_state(std::span<const std::byte> bytes,
                                           const std::string& file);

/// Hashes of those parts of a model that the state depends on; how long the run is and what it
/// writes is not among them.
[[nodiscard]] std::vector<std::uint64_t> fingerprint(const Model& model);
/// Holds a state against the model that shall go on with it. Errors: InputError: another deck, and
/// what differs
void check_same_model(const CheckpointState& state, const Model& model, const std::string& file);

}  // namespace barchan
