#pragma once

#include <cstdint>
#include <vector>

#include <barchan/core/brick/brick.hpp>
#include <barchan/core/brick/departure.hpp>

// What a run that goes wrong says of a brick, between steps.

namespace barchan {

/// Owned particles out of the domain.
template <int Dim>
[[nodiscard]] std::vector<Departure> outside(const Brick<Dim>& brick, std::int64_t step);
/// The largest id of an owned particle out of the domain; 0: none is.
template <int Dim>
[[nodiscard]] std::int64_t last_outside(const Brick<Dim>& brick);

/// Of a particle the contact forces in the last step, by size, where they were more than can be
/// summed exactly [N]; else zero.
template <int Dim>
[[nodiscard]] double overload(const Brick<Dim>& brick) {
  return brick.speeds.top_force > brick.world->grain.most() ? brick.speeds.top_force : 0.0;
}
/// The same of heat flows [W].
template <int Dim>
[[nodiscard]] double heat_overload(const Brick<Dim>& brick) {
  return brick.top_flow > brick.world->heat.grain.most() ? brick.top_flow : 0.0;
}
/// The last step went wrong: a particle is fast, two passed each other, or forces or heat flows are
/// too large.
template <int Dim>
[[nodiscard]] bool must_stop(const Brick<Dim>& brick) {
  return brick.is_fast || brick.passage.exists() || overload(brick) > 0.0 ||
         heat_overload(brick) > 0.0;
}

/// Of those that are fast the one with the lowest id. @pre brick.is_fast
template <int Dim>
[[nodiscard]] std::int32_t first_fast_row(const Brick<Dim>& brick);
/// One that is not finite before all others. -1: there is none
template <int Dim>
[[nodiscard]] std::int32_t fastest_row(const Brick<Dim>& brick);
/// Ids of owned particles that touch another one, of any brick, are added to `ids`.
template <int Dim>
void find_touching(const Brick<Dim>& brick, const Suspect& other, std::vector<std::int64_t>& ids);

/// What a particle touches.
struct Partners {
  std::vector<std::int64_t> ids;    ///< ascending
  std::vector<std::int32_t> walls;  ///< ascending
};
/// What a row touched as the last step began. Of one that is not finite now nobody knows where it
/// was: all that was near it when lists were built. The published scheme knows ghosts on the
/// right as they were then.
template <int Dim>
[[nodiscard]] Partners partners_before_step(const Brick<Dim>& brick, std::int32_t row);
template <int Dim>
[[nodiscard]] WorstOverlap worst_overlap(const Brick<Dim>& brick);
/// Nothing where stiffness does not grow with overlap.
template <int Dim>
[[nodiscard]] StiffestContact stiffest_contact(const Brick<Dim>& brick);

}  // namespace barchan
