#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace barchan {

/// Rows [begin, end) whose forces are complete: kick, drift, forces back to zero.
///
///   dv  = F·kick/m + g·kick
///   dv −= alpha·|dv|·sign(v)      Cundall's local damping, of spins too
///   v  += dv
///   x  += dt·v                    leapfrog: v is half a step behind x
///
/// `kick` is dt, and dt/2 in the first step of a run, which makes the scheme second order from the
/// start. Source: Cundall & Strack 1979; local damping: Cundall 1987.
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
  double most_force = std::numeric_limits<double>::infinity();  ///< ForceGrain::most() [N]
  const std::int64_t* id = nullptr;                             ///< of every row
};

/// A row whose sum of forces was too large to be exact.
struct Overload {
  std::int64_t id = 0;  ///< 0: there was none; of several the lowest
  double force = 0.0;   ///< sum of the sizes of all contributions [N]
  void add(const Overload& other) {
    if (other.id != 0 && (id == 0 || other.id < id)) *this = other;
  }
};

/// How fast rows drifted.
struct RowSpeeds {
  double top = 0.0;        ///< upper bound [m/s]; 3D, where lists of near pairs rest on it
  bool is_beyond = false;  ///< some component is beyond the job's most_speed, or no number
  Overload overload;
  void add(const RowSpeeds& other) {
    top = std::max(top, other.top);
    is_beyond = is_beyond || other.is_beyond;
    overload.add(other.overload);
  }
};

using RowKernel = RowSpeeds (*)(const RowJob&);

}  // namespace barchan
