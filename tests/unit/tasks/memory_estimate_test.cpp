#include <barchan/tasks/memory_estimate.hpp>

#include <gtest/gtest.h>

#include <barchan/core/deck/deck.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/tasks/simulation.hpp>

#include <support/mpi_session.hpp>

#include "../core/deck_text.hpp"

namespace barchan {
namespace {

TEST(MemoryEstimate, IsWhatASimulationOfOneThreadTakes) {
  const MPI_Comm world = test::world();
  const Deck deck = parse_deck(deck_test::good_deck(), "test.toml");
  Model model = deck.model;
  model.time.allow_unstable = true;
  const ParticleSet set = make_particles(model, deck.sources);
  ASSERT_FALSE(set.bonds.empty());

  const std::size_t bytes = memory_estimate(model, set);

  RunOptions options;
  options.threads = 1;
  const Simulation simulation(model, set, world, options);
  EXPECT_EQ(bytes, simulation.memory_bytes());
}

}  // namespace
}  // namespace barchan
