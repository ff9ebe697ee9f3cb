// Every case needs an MPI of its own, and so a process of its own.
#include <gtest/gtest.h>
#include <mpi.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>

#include <barchan/core/base/error.hpp>
#include <barchan/core/deck/deck.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/tasks/simulation.hpp>

#include "../core/deck_text.hpp"

namespace barchan {
namespace {

std::unique_ptr<Simulation> make_simulation(int threads) {
  Deck deck = parse_deck(deck_test::good_deck(), "test.toml");
  deck.model.time.allow_unstable = true;
  const ParticleSet set = make_particles(deck.model, deck.sources);
  RunOptions options;
  options.threads = threads;
  return std::make_unique<Simulation>(deck.model, set, MPI_COMM_WORLD, options);
}

void start_mpi(int level) {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, level, &provided);
}

/// Ends the process with 7, and says why, where a simulation is refused.
[[noreturn]] void end_with(int threads) {
  try {
    make_simulation(threads)->run(2);
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    MPI_Finalize();
    std::_Exit(7);
  }
  MPI_Finalize();
  std::_Exit(0);
}

class ThreadLevel : public testing::Test {
 protected:
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(ThreadLevel, OfOneThreadAllowsNoTwo) {
  for (const int level : {MPI_THREAD_SINGLE, MPI_THREAD_FUNNELED}) {
    EXPECT_EXIT(
        {
          start_mpi(level);
          end_with(2);
        },
        testing::ExitedWithCode(7), "several threads need MPI_THREAD_SERIALIZED");
  }
}

TEST_F(ThreadLevel, OfOneThreadRunsOneThreadAlsoByDefault) {
  for (const int threads : {0, 1}) {
    EXPECT_EXIT(
        {
          start_mpi(MPI_THREAD_SINGLE);
          end_with(threads);
        },
        testing::ExitedWithCode(0), "");
  }
}

TEST_F(ThreadLevel, OfOneThreadIsThatOfTheThreadThatStartedMpi) {
  EXPECT_EXIT(
      {
        start_mpi(MPI_THREAD_FUNNELED);
        std::thread([] { end_with(1); }).join();
      },
      testing::ExitedWithCode(7), "only the thread that started MPI");
}

TEST_F(ThreadLevel, ASimulationOutlivesMpi) {
  EXPECT_EXIT(
      {
        start_mpi(MPI_THREAD_SERIALIZED);
        {
          const auto simulation = make_simulation(2);
          simulation->run(5);
          MPI_Finalize();
          try {
            simulation->run(1);
          } catch (const RunError& error) {
            std::fprintf(stderr, "%s\n", error.what());
          }
        }
        std::exit(0);
      },
      testing::ExitedWithCode(0), "MPI has ended");
}

}  // namespace
}  // namespace barchan
