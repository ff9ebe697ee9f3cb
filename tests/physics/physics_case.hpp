#pragma once

#include <mpi.h>

#include <functional>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/core/deck/deck.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/tasks/simulation.hpp>

// Small runs for tests against closed forms: a deck's text in, one thread, all ranks.

namespace barchan::test {

/// @param set  overrides such as "time.step=1e-5" @param file  of the deck; paths in it start there
inline Simulation simulate(std::string_view deck, const std::vector<std::string>& set = {},
                           const std::string& file = "test.toml") {
  std::vector<DeckOverride> overrides;
  for (const std::string& argument : set) overrides.push_back(parse_override(argument));
  const Deck read = parse_deck(deck, file, overrides);
  RunOptions options;
  options.threads = 1;
  return {read.model, make_particles(read.model, read.sources), MPI_COMM_WORLD, options};
}

/// @throws std::out_of_range when this rank does not own it
inline OwnedParticle particle(const Simulation& simulation, std::int64_t id) {
  std::vector<OwnedParticle> found;
  simulation.for_each_owned([&](const OwnedParticle& p) {
    if (p.id == id) found.push_back(p);
  });
  return found.at(0);
}

/// Sets a force on some particles by id, none on the others.
inline void push(Simulation& simulation,
                 std::initializer_list<std::pair<std::int64_t, Vec3>> forces) {
  simulation.apply_forces([&forces](const OwnedParticle& p) {
    for (const auto& [id, force] : forces) {
      if (id == p.id) return force;
    }
    return Vec3(Vec3::Zero());
  });
}

/// Kinetic, elastic and gravitational energy at one instant [J]: velocities are half a step off the
/// positions, so the kinetic energies before and after are averaged. Makes a step.
inline double total_energy(Simulation& simulation) {
  const Measures before = simulation.measure();
  simulation.run(1);
  const Measures after = simulation.measure();
  return 0.5 * (before.kinetic.value() + after.kinetic.value()) + before.elastic.value() +
         before.gravitational.value();
}

}  // namespace barchan::test
