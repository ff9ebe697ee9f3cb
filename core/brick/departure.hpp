#pragma once

#include <cstdint>
#include <tuple>

namespace barchan {

/// A particle that is out of the domain, as it was when that was noticed. Plain data: it travels
/// between ranks.
struct Departure {
  std::int64_t step = 0;
  std::int64_t id = 0;
  double position[3] = {};  ///< [m]
  double velocity[3] = {};  ///< [m/s]
};

/// A particle that a run is about to end for. Plain data: it travels between ranks.
struct Suspect {
  std::int64_t id = 0;      ///< 0: there is none
  double position[3] = {};  ///< [m]
  double velocity[3] = {};  ///< [m/s]
  double radius = 0.0;      ///< [m]
  double speed2 = -1.0;  ///< squared speed [m²/s²]; the largest number when something is not finite
};

/// What overlaps most, as a share of the smaller radius. Plain data: it travels between ranks.
struct WorstOverlap {
  double share = 0.0;
  double overlap = 0.0;     ///< [m]
  std::int64_t id = 0;      ///< of the particle; 0: nothing overlaps
  std::int64_t with = 0;    ///< id of the other particle, or
  std::int32_t wall = -1;   ///< the number of a wall
  double position[3] = {};  ///< [m], of the particle

  /// Of equal ones the lowest numbers count, so that it does not matter who looks first.
  [[nodiscard]] bool is_worse_than(const WorstOverlap& other) const {
    return share > other.share ||
           (share == other.share &&
            std::tie(id, with, wall) < std::tie(other.id, other.with, other.wall));
  }
};

/// Two for which the step is longest, beside what is stable for them as they overlap.
struct StiffestContact {
  double step_share = 0.0;  ///< the step over the stable one
  WorstOverlap at;

  [[nodiscard]] bool is_worse_than(const StiffestContact& other) const {
    return step_share > other.step_share ||
           (step_share == other.step_share && at.is_worse_than(other.at));
  }
};

/// Contacts with history, contacts with walls that have one, and bonds; each counted on one lane.
struct LinkCounts {
  std::int64_t contacts = 0, wall_contacts = 0, bonds = 0;
  LinkCounts& operator+=(const LinkCounts& other) {
    contacts += other.contacts;
    wall_contacts += other.wall_contacts;
    bonds += other.bonds;
    return *this;
  }
  friend bool operator==(const LinkCounts&, const LinkCounts&) = default;
};

/// Particles that left the domain since the start, and the contacts and bonds that they took along.
struct LeftDomain {
  std::int64_t particles = 0;
  LinkCounts links;
};

/// What a lane can be made to lose in its next rebuild, to show that it is noticed.
enum class Loss { Nothing, Particle, Contact, WallContact, Bond };

}  // namespace barchan
