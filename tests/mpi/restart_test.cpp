// 2N steps are N steps, a checkpoint, and N more: on other numbers of ranks and threads, from any
// step, through any exchange. What is compared is the digest and everything that goes into a row of
// a series.
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>

#include "law_scenarios.hpp"
#include "running.hpp"

namespace barchan::test {
namespace {

/// The first ranks of the world; null on the others.
class FirstRanks {
 public:
  explicit FirstRanks(int count) {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_split(MPI_COMM_WORLD, rank < count ? 0 : MPI_UNDEFINED, 0, &comm_);
  }
  ~FirstRanks() {
    if (comm_ != MPI_COMM_NULL) MPI_Comm_free(&comm_);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  FirstRanks(const FirstRanks&) = delete;
  FirstRanks& operator=(const FirstRanks&) = delete;
  [[nodiscard]] bool has_me() const { return comm_ != MPI_COMM_NULL; }
  [[nodiscard]] MPI_Comm get() const { return comm_; }

 private:
  MPI_Comm comm_ = MPI_COMM_NULL;
};

CheckpointSpec by_steps(std::int64_t every) {
  return {every, 0.0, 1000};
}

/// With a skin that the fastest particles do not outrun.
Scenario with_skin(Scenario s, double skin) {
  s.model.search.skin = skin;
  return s;
}

/// The middle of a run is not where a rebuild or a stage happens to be.
std::int64_t middle_of(const Scenario& s) {
  return s.num_steps / 2 + 7;
}

Scenario with_energy(Scenario s) {
  s.model.output.energy = true;
  return s;
}

std::vector<Scenario> restart_scenarios() {
  return {with_energy(soil_with_ring_and_plate()),
          with_energy(column_collapse()),
          gas(2, {true, true, false}, 3.0, "2D gas, all periodic"),
          gas(3, {true, false, true}, 3.0, "3D gas, periodic"),
          moving_walls(),
          rough_bed(),
          with_energy(pushed_by_caller()),
          breaking_plate(2),
          with_skin(breaking_plate(3), 0.04),
          with_energy(with_skin(expansion(), 0.04)),
          two_particles(true),
          many_laws(3, true),
          strips_along_y(),
          plates_at_borders(),
          hertz_column(),
          hertz_gas(),
          rolling_shear_flow(),
          rolling_hertz_gas(),
          rolling_column(),
          sticky_gas(Adhesion::Sjkr2, true),
          sticky_gas(Adhesion::Bridge, false),
          attracting_gas(true),
          with_heat(soil_with_ring_and_plate(), 400.0),
          with_heat(attracting_gas(false), 200.0)};
}

class RestartOf : public testing::TestWithParam<int> {
 protected:
  RestartOf() : scenario_(restart_scenarios()[static_cast<std::size_t>(GetParam())]) {}

  Course reference() const {
    Course run;
    const FirstRanks one(1);
    if (one.has_me())
      run = whole_run(scenario_, one.get(), with_threads(1), middle_of(scenario_), "");
    for (Words* words : {&run.middle, &run.end}) {
      std::uint64_t size = words->size();
      MPI_Bcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
      words->resize(size);
      MPI_Bcast(words->data(), static_cast<int>(size), MPI_UINT64_T, 0, MPI_COMM_WORLD);
    }
    return run;
  }

  Scenario scenario_;
};

TEST_P(RestartOf, GivesTheSameBitsOnAnyNumberOfRanksAndThreads) {
  SCOPED_TRACE(scenario_.name);
  const SharedFolder folder;
  const Course expected = reference();
  const std::int64_t middle = middle_of(scenario_);
  for (const int writers : {1, 2, 3}) {
    if (writers > num_ranks()) continue;
    {
      const FirstRanks ranks(writers);
      if (ranks.has_me()) {
        const Course run =
            whole_run(scenario_, ranks.get(), with_threads(1 + writers % 2), middle, folder.path());
        EXPECT_EQ(run.end, expected.end) << writers << " ranks, not restarted";
      }
    }
    for (const int readers : {1, 2, 4}) {
      if (readers > num_ranks()) continue;
      SCOPED_TRACE(fmt::format("{} ranks, then {}", writers, readers));
      const FirstRanks ranks(readers);
      if (!ranks.has_me()) continue;
      Simulation sim = Simulation::restore(scenario_.model, folder.at(middle), ranks.get(),
                                           with_threads(1 + (writers + readers) % 2));
      EXPECT_EQ(words_of(sim), expected.middle);
      sim.run(scenario_.num_steps - middle);
      EXPECT_EQ(words_of(sim), expected.end);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, RestartOf, testing::Range(0, 24));

/// Restarts from every step of a stretch, so from before, at and after rebuilds, with and without
/// checks in flight.
void restart_from_every_step(const Scenario& s, const RunOptions& writer,
                             const RunOptions& reader) {
  constexpr std::int64_t kFrom = 100, kTo = 148, kBeyond = 40;
  const SharedFolder folder;
  std::vector<std::uint64_t> digests;
  std::int64_t rebuilds = 0;
  {
    Simulation sim(s.model, s.set, MPI_COMM_WORLD, writer);
    sim.run(kFrom - 1);
    rebuilds = -sim.timings().rebuilds;
    sim.keep_checkpoints(folder.path(), by_steps(1));
    for (std::int64_t step = kFrom - 1; step < kTo + kBeyond; ++step) {
      sim.run(1);
      digests.push_back(sim.digest());
      if (step + 1 == kTo) rebuilds += sim.timings().rebuilds;
    }
    EXPECT_TRUE(sim.finish_checkpoints());
  }
  EXPECT_GT(rebuilds, 1);
  for (std::int64_t step = kFrom; step < kTo; ++step) {
    Simulation sim = Simulation::restore(s.model, folder.at(step), MPI_COMM_WORLD, reader);
    EXPECT_EQ(sim.step(), step);
    sim.run(kBeyond);
    ASSERT_EQ(sim.digest(), digests[static_cast<std::size_t>(step + kBeyond - kFrom)])
        << s.name << ", from step " << step;
  }
}

TEST(Restart, MayBeginAtAnyStep) {
  restart_from_every_step(with_skin(expansion(), 0.03), with_threads(1), with_threads(2));
  restart_from_every_step(breaking_plate(2), with_threads(2), with_threads(1));
}

TEST(Restart, MayBeginAtAnyStepWithAPlate) {
  Scenario s = soil_with_ring_and_plate();
  s.model.stages[0].max_time = 0.02;  // the plate comes at step 100
  restart_from_every_step(moving_walls(), with_threads(1), with_threads(1));
  s.model.time.step = 4e-4;
  s.model.stages[0].max_time = 0.048;  // and here at step 120
  s.model.search.skin = 0.01;
  restart_from_every_step(s, with_threads(1), with_threads(1));
}

TEST(Restart, MayBeginWhereLanesThatGoAheadOfEachOtherStopped) {
  const Scenario s = with_skin(expansion(), 0.03);
  constexpr std::int64_t kFrom = 60, kEnd = 160;
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  sim.run(kEnd);
  const Words expected = words_of(sim);
  for (const std::int64_t every : {3, 4, 5, 7}) {
    const SharedFolder folder;
    Simulation writer(s.model, s.set, MPI_COMM_WORLD, with_threads(2));
    writer.keep_checkpoints(folder.path(), by_steps(every));
    writer.run(kEnd);
    EXPECT_TRUE(writer.finish_checkpoints());
    EXPECT_EQ(words_of(writer), expected) << "a checkpoint every " << every << " steps";
    for (std::int64_t step = kFrom / every * every; step < kEnd; step += every) {
      Simulation reader =
          Simulation::restore(s.model, folder.at(step), MPI_COMM_WORLD, with_threads(2));
      reader.run(kEnd - step);
      ASSERT_EQ(words_of(reader), expected) << "every " << every << ", from step " << step;
    }
  }
}

TEST(Restart, GoesThroughEveryExchange) {
  const Scenario s = breaking_plate(2);
  const std::int64_t middle = middle_of(s);
  const SharedFolder folder;
  const Course expected =
      whole_run(s, MPI_COMM_WORLD, with_threads(1, "return"), middle, folder.path());
  for (const std::string& exchange : exchange_choices()) {
    if (exchange == "replay") continue;
    SCOPED_TRACE(exchange);
    std::optional<Simulation> sim;
    try {
      sim.emplace(Simulation::restore(s.model, folder.at(middle), MPI_COMM_WORLD,
                                      with_threads(1, exchange)));
    } catch (const InputError&) {
      continue;  // not on this machine
    }
    EXPECT_EQ(words_of(*sim), expected.middle);
    sim->run(s.num_steps - middle);
    EXPECT_EQ(words_of(*sim), expected.end);
  }
}

TEST(Restart, WorksWithEveryPairSearched) {
  const Scenario s = soil_with_ring_and_plate();
  const std::int64_t middle = middle_of(s);
  const SharedFolder folder;
  RunOptions all_pairs = with_threads(1);
  all_pairs.search = ContactSearchKind::AllPairs;
  const Course expected = whole_run(s, MPI_COMM_WORLD, all_pairs, middle, folder.path());
  for (const auto search : {ContactSearchKind::AllPairs, ContactSearchKind::Cells}) {
    RunOptions options = with_threads(2);
    options.search = search;
    Simulation sim = Simulation::restore(s.model, folder.at(middle), MPI_COMM_WORLD, options);
    sim.run(s.num_steps - middle);
    EXPECT_EQ(words_of(sim), expected.end);
  }
}

TEST(Restart, MayBeRepeated) {
  const Scenario s = column_collapse();
  const SharedFolder folder;
  const Course expected = whole_run(s, MPI_COMM_WORLD, with_threads(1), 50, folder.path());
  for (std::int64_t step = 50; step < s.num_steps; step += 50) {
    Simulation sim = Simulation::restore(s.model, folder.at(step), MPI_COMM_WORLD,
                                         with_threads(1 + static_cast<int>(step / 50 % 2)));
    sim.keep_checkpoints(folder.path(), by_steps(50));
    sim.run(50);
    sim.save_checkpoint();
    EXPECT_TRUE(sim.finish_checkpoints());
    if (sim.step() == s.num_steps) {
      EXPECT_EQ(words_of(sim), expected.end);
    }
  }
}

}  // namespace
}  // namespace barchan::test
