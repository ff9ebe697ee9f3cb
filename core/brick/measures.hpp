#pragma once

#include <cstdint>
#include <limits>

#include <barchan/core/base/exact_sum.hpp>
#include <barchan/core/brick/energy_works.hpp>

namespace barchan {

/// Sums over a brick, added over bricks and ranks in any order.
struct Measures {
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  ExactSum kinetic, elastic, gravitational;  ///< [J]
  ExactSum bonds_elastic;                    ///< the part of `elastic` that bonds have [J]
  /// The parts that tangential springs, and those of rolling and twisting have; with output.energy.
  ExactSum sliding_elastic, rolling_elastic;
  ExactSum momentum[3];       ///< [N·s]
  std::int64_t contacts = 0;  ///< touching pairs without a bond, each once
  std::int64_t bonds = 0, broken_bonds = 0;
  double max_overlap = 0.0;        ///< [m], with particles or walls
  double max_overlap_share = 0.0;  ///< of the smaller radius
  double max_speed = 0.0;          ///< [m/s]
  double max_inverse_mass = 0.0;   ///< of the lightest particle [1/kg]
  ExactSum heat, heat_capacity;    ///< m·c·T [J] and m·c [J/K]; where heat is on
  double max_temperature = -kNever, min_temperature = kNever;  ///< [K]; without any infinite
  EnergyWorks works;  ///< since the start; empty without output.energy
  /// Of all particles, once heat has spread evenly [K].
  [[nodiscard]] double mean_temperature() const { return heat.value() / heat_capacity.value(); }
  void add(const Measures& other);
};

/// Where energy has come from and gone to since the account began (output.energy) [J]. Losses are
/// positive where energy goes.
struct EnergyBudget {
  double wall_work = 0.0, gravity_work = 0.0, caller_work = 0.0;  ///< on particles
  /// Dashpots, sliding and rolling, and what forms and breaks where surfaces or liquid pull: what
  /// contacts have taken and do not hold.
  double contact_loss = 0.0;
  /// Of it, as each contact tells step by step (Losses), less what springs hold. The rest is what
  /// contacts that form and break set free, and what the finite step makes.
  double dashpot_loss = 0.0, sliding_loss = 0.0, rolling_loss = 0.0;
  double bond_loss = 0.0;     ///< dashpots, and what broken bonds held
  double damping_loss = 0.0;  ///< local damping
  double departed = 0.0;      ///< kinetic energy of particles that have left
  /// Energy that is there, and that should be by all the others.
  double error = 0.0;
};
/// @param wall_work  of all walls since the start
[[nodiscard]] EnergyBudget budget_of(const Measures& m, double wall_work);

/// How far particles have come since the last rebuild, and how fast they are. A distance beyond
/// half the skin that was reached between a check and the rebuild it led to is told by the next
/// check.
struct Travel {
  double distance2 = 0.0;  ///< largest squared displacement [m²]
  double speed2 = 0.0;     ///< largest squared speed [m²/s²]
};

}  // namespace barchan
