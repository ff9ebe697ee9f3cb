// What a caller can get wrong, and what every rank then hears; and simulations that live on after
// MPI.
#include <gtest/gtest.h>
#include <mpi.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <barchan/core/base/error.hpp>

#include "running.hpp"
#include "scenarios.hpp"

namespace barchan::test {
namespace {

template <class Error, class Call>
std::string words_of(Call&& call) {
  try {
    call();
  } catch (const Error& e) {
    return e.what();
  }
  return "no such error";
}

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' in '" << text << "'";
}

bool is_last() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank + 1 == num_ranks();
}

template <class Spoil>
std::string words_when_the_last_rank(Spoil&& spoil) {
  Scenario s = gas(2, {true, true, false}, 1.0, "gas");
  RunOptions options = with_threads(1);
  if (is_last()) spoil(s, options);
  return words_of<InputError>([&] { Simulation(s.model, s.set, MPI_COMM_WORLD, options); });
}

TEST(Library, FindsWhatDiffersBetweenRanks) {
  if (num_ranks() == 1) return;  // one rank has none to differ from
  const std::string last = "rank " + std::to_string(num_ranks() - 1);
  const std::string position = words_when_the_last_rank(
      [](Scenario& s, RunOptions&) { s.set.particles[3].position[0] += 1e-15; });
  expect_part(position, "the particles of " + last + " differ");
  const std::string order = words_when_the_last_rank(
      [](Scenario& s, RunOptions&) { std::swap(s.set.particles[3], s.set.particles[4]); });
  expect_part(order, "the particles of " + last + " differ");
  const std::string model =
      words_when_the_last_rank([](Scenario& s, RunOptions&) { s.model.gravity[0] = 1e-9; });
  expect_part(model, "the model of " + last + " differs");
  const std::string dimension =
      words_when_the_last_rank([](Scenario& s, RunOptions&) { s.model.dimension = 3; });
  expect_part(dimension, "the model of " + last + " differs");
  const std::string options =
      words_when_the_last_rank([](Scenario&, RunOptions& o) { o.exchange = "isend"; });
  expect_part(options, "the options of " + last + " differ");
}

TEST(Library, RefusesAModelThatCannotRunOnEveryRank) {
  Scenario s = gas(2, {true, true, false}, 1.0, "gas");
  s.model.stages.clear();
  expect_part(words_of<InputError>([&] { Simulation(s.model, s.set, MPI_COMM_WORLD); }), "stage");
  s.model.stages = {Stage{}};
  s.set.particles[0].omega[0] = 1.0;
  expect_part(words_of<InputError>([&] { Simulation(s.model, s.set, MPI_COMM_WORLD); }),
              "leaves the plane");
}

TEST(Library, SaysWhichCallComesFirst) {
  const Scenario s = moving_walls();
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  expect_part(words_of<std::logic_error>([&] { sim.save_checkpoint(); }), "keep_checkpoints");
  expect_part(words_of<std::logic_error>([&] { sim.run(-1); }), "-1 steps");
  expect_part(words_of<InputError>([&] { sim.keep_checkpoints(".", {0, 0.0, 0}); }), "keep = 0");
  expect_part(words_of<std::logic_error>([&] { sim.write_trace("t.json"); }), "trace");
  Simulation other = std::move(sim);
  expect_part(words_of<std::logic_error>([&] { (void)sim.step(); }), "moved from");
  EXPECT_EQ(other.run(3), 3);
}

TEST(Library, RepeatsAnErrorThatEndedTheRun) {
  Scenario s = two_particles(false);
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  const std::string first = words_of<AgreedError>([&] { sim.run(6000); });
  expect_part(first, "out of the domain");
  const std::int64_t step = sim.step();

  EXPECT_EQ(words_of<AgreedError>([&] { sim.run(1); }), first);
  EXPECT_EQ(sim.step(), step);
  EXPECT_EQ(sim.measure().contacts, 0);  // the state can still be read
}

TEST(Library, RefusesWhatIsNotBetweenSteps) {
  Scenario s = two_particles(false);
  s.model.domain.outside = OutsidePolicy::Delete;
  Simulation sim(s.model, s.set, MPI_COMM_SELF, with_threads(1));
  int told = 0;
  sim.on_departure([&](std::span<const Departure>) {
    ++told;
    expect_part(words_of<std::logic_error>([&] { sim.run(1); }), "from within run()");
    expect_part(words_of<std::logic_error>([&] { (void)sim.measure(); }), "from within run()");
  });
  sim.run(6000);
  EXPECT_GT(told, 0);
}

TEST(Library, ARequestToStopStopsOneRunOnce) {
  const Scenario s = moving_walls();
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  if (is_root()) Simulation::request_stop();
  EXPECT_LT(sim.run(100), 50);
  EXPECT_TRUE(sim.stopped());
  MPI_Barrier(MPI_COMM_WORLD);

  EXPECT_EQ(sim.run(40), 40);
  EXPECT_FALSE(sim.stopped());
  Simulation other(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  EXPECT_EQ(other.run(40), 40);
}

TEST(Library, KnowsTheCheckpointThatItGoesOnFrom) {
  const SharedFolder folder;
  const Scenario s = moving_walls();
  {
    Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
    sim.keep_checkpoints(folder.path(), {});
    sim.run(20);
    sim.save_checkpoint();
    ASSERT_TRUE(sim.finish_checkpoints());
  }
  Simulation sim = Simulation::restore(s.model, folder.at(20), MPI_COMM_WORLD, with_threads(1));
  EXPECT_EQ(sim.last_checkpoint(), is_root() ? folder.at(20) : "");
  sim.keep_checkpoints(folder.path(), {});
  EXPECT_EQ(sim.last_checkpoint(), is_root() ? folder.at(20) : "");
  sim.run(10);
  sim.save_checkpoint();
  ASSERT_TRUE(sim.finish_checkpoints());
  EXPECT_EQ(sim.last_checkpoint(), is_root() ? folder.at(30) : "");
}

/// Destroyed after main has ended MPI: the program's status tells whether that went well.
std::vector<std::unique_ptr<Simulation>>& survivors() {
  static std::vector<std::unique_ptr<Simulation>> all;
  return all;
}

TEST(Library, ASimulationOutlivesMpi) {
  const Scenario s = moving_walls();
  for (const std::string& exchange : exchange_choices()) {
    survivors().push_back(
        std::make_unique<Simulation>(s.model, s.set, MPI_COMM_WORLD, with_threads(2, exchange)));
    survivors().back()->run(20);
  }
}

}  // namespace
}  // namespace barchan::test
