#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace barchan {

/// Rows [begin, end) whose forces are complete: kick, drift, forces back to where they start from.
///
///   dv  = F·kick/m + g·kick
///   dv −= alpha·|dv|·sign(v)      Cundall's local damping, of spins too
///   v  += dv
///   x  += dt·v                    leapfrog: v is half a step behind x
///
/// `kick` is the time between the two velocities: half of the last step and half of this one. So it
/// is dt, and dt/2 in the first step of a run, which makes the scheme second order from the start.
/// Source: Cundall & Strack 1979; local damping: Cundall 1987.
struct RowJob {
  double* motion = nullptr;
  double* spin = nullptr;
  double* force = nullptr;
  std::int32_t begin = 0, end = 0;
  double kick = 0.0, dt = 0.0;
  double gravity[3] = {};
  double local_damping = 0.0;
  double most_speed =
      std::numeric_limits<double>::infinity();  ///< of a component of velocity [m/s]
  double rounder = 0.0;           ///< ForceGrain::rounder(): what sums of forces start from [N]
  const double* extra = nullptr;  ///< force records that are added, row `begin` first; or none
};

/// How fast rows drifted.
struct RowSpeeds {
  double top = 0.0;        ///< upper bound [m/s]; 3D, where lists of near pairs rest on it
  bool is_beyond = false;  ///< some component is beyond the job's most_speed, or no number
  double top_force = 0.0;  ///< largest sum of the sizes of a row's contact forces [N]
  void add(const RowSpeeds& other) {
    top = std::max(top, other.top);
    is_beyond = is_beyond || other.is_beyond;
    top_force = std::max(top_force, other.top_force);
  }
};

using RowKernel = RowSpeeds (*)(const RowJob&);

}  // namespace barchan
