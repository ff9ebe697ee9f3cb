#pragma once

#include <cstdint>
#include <span>
#include <tuple>

#include <barchan/core/base/rows.hpp>
#include <barchan/core/brick/departure.hpp>
#include <barchan/core/brick/world.hpp>
#include <barchan/core/links/walls.hpp>
#include <barchan/core/particles/particle_store.hpp>
#include <barchan/core/search/pair_list.hpp>

// Contacts that a step would skip.
//
// Let s be the relative motion of two in a step and r the smaller of their radii (a plate has none,
// so the particle's counts). Where |s| <= r, no contact deeper than 0.14·r is skipped: a chord that
// is shorter than s lies that close to the edge of the other one; and the first step that finds a
// contact finds it before the smaller one's centre is in the other. Beyond that the motion itself
// is looked at, as a straight line:
//
//        ○ - - - -( - )- - ●            passed: apart as the step began, and on the way nearer than
//                                       contact and nearer than at its end
//        ○ - - - -( ●  )                passed: on the way deeper in the other than r
//
// A plate is passed whenever a centre goes through it, however short s is: then its contact was too
// soft; and where a step ends on a plate's face that it should have met at its end:
//
//        ○ - - - ▐███●███    the first contact would push back, that at the step's end to the side
//
// Nothing passes a plane, which has no other side.

namespace barchan {

/// Two of which one went through the other in a step. Plain data.
struct Passage {
  Suspect first;           ///< as the step ended; the lower id; 0: there is none
  Suspect second;          ///< id 0: it is a wall
  std::int32_t wall = -1;  ///< its number
  double travel = 0.0;     ///< |s| [m]
  double mass = 0.0;       ///< of both together, 1/(1/m + 1/m) [kg]
  double stiffness = 0.0;  ///< of a spring that stores what their contact does, as the smaller
                           ///< radius overlaps [N/m]

  [[nodiscard]] bool exists() const { return first.id != 0; }
  /// Keeps that with the lowest ids.
  void add(const Passage& other) {
    const bool is_first =
        std::tie(other.first.id, other.second.id, other.wall) < std::tie(first.id, second.id, wall);
    if (other.exists() && (!exists() || is_first)) *this = other;
  }
};

/// Keeps the first of what it is shown. Call it where positions are those after a step of `dt`, and
/// velocities those of that step.
template <int Dim>
class PassageWatch {
 public:
  PassageWatch(const World<Dim>& world, const ParticleStore<Dim>& store, Passage& found)
      : world_(world), store_(store), found_(found) {}

  /// Contacts of particles that moved farther than the smaller radius.
  void look_at(const PairList& pairs) const;
  /// Contacts of rows [begin, end) with plates.
  void look_at(std::span<const WallContact<Dim>> contacts, Rows rows) const;

 private:
  [[nodiscard]] double stiffness(std::uint8_t code, const Overlap& overlap) const;

  const World<Dim>& world_;
  const ParticleStore<Dim>& store_;
  Passage& found_;
};

/// How far a row moved in its last step [m]; not a number where its state is none.
template <int Dim>
[[nodiscard]] double step_travel(const ParticleStore<Dim>& store, double dt, std::int32_t row);
/// The farthest of some rows [m]; infinite where a state is not a number.
template <int Dim>
[[nodiscard]] double farthest_travel(const ParticleStore<Dim>& store, double dt, Rows rows);

template <int Dim>
[[nodiscard]] Suspect suspect_of(const ParticleStore<Dim>& store, std::int32_t row);

extern template class PassageWatch<2>;
extern template class PassageWatch<3>;

}  // namespace barchan
