// 2N steps are N steps, a checkpoint, and N more: on other numbers of ranks and threads, from any
// step, through any exchange. What is compared is the digest and everything that goes into a row of
// a series.
#include <gtest/gtest.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/format.h>

#include <barchan/core/checkpoint/checkpoint_folder.hpp>
#include <barchan/core/error.hpp>
#include <barchan/tasks/checkpoint_load.hpp>

#include "scenarios.hpp"

namespace fs = std::filesystem;

namespace barchan::test {
namespace {

using Words = std::vector<std::uint64_t>;

int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

int world_size() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

/// The first ranks of the world; null on the others.
class FirstRanks {
 public:
  explicit FirstRanks(int count) {
    MPI_Comm_split(MPI_COMM_WORLD, rank_of(MPI_COMM_WORLD) < count ? 0 : MPI_UNDEFINED, 0, &comm_);
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

/// A folder that all ranks see, gone after the test.
class SharedFolder {
 public:
  SharedFolder() {
    std::array<char, 64> name{};
    if (rank_of(MPI_COMM_WORLD) == 0) {
      std::snprintf(name.data(), name.size(), "restart_test_XXXXXX");
      if (mkdtemp(name.data()) == nullptr) name.fill('\0');
    }
    MPI_Bcast(name.data(), static_cast<int>(name.size()), MPI_CHAR, 0, MPI_COMM_WORLD);
    path_ = name.data();
  }
  ~SharedFolder() {
    MPI_Barrier(MPI_COMM_WORLD);
    std::error_code ignored;
    if (rank_of(MPI_COMM_WORLD) == 0) fs::remove_all(path_, ignored);
  }
  SharedFolder(const SharedFolder&) = delete;
  SharedFolder& operator=(const SharedFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string at(std::int64_t step) const {
    return fmt::format("{}/step_{:09}", path_, step);
  }

 private:
  std::string path_;
};

Words words_of(Simulation& sim) {
  const Measures m = sim.measure();
  Words words{sim.digest(),
              static_cast<std::uint64_t>(sim.step()),
              static_cast<std::uint64_t>(sim.stage()),
              static_cast<std::uint64_t>(m.contacts),
              static_cast<std::uint64_t>(m.bonds),
              static_cast<std::uint64_t>(m.broken_bonds)};
  const auto add = [&](double value) { words.push_back(std::bit_cast<std::uint64_t>(value)); };
  for (const double value :
       {m.kinetic.value(), m.elastic.value(), m.gravitational.value(), m.max_overlap, m.max_speed,
        m.momentum[0].value(), m.momentum[1].value(), m.momentum[2].value()}) {
    add(value);
  }
  for (const WallState& w : sim.walls()) {
    for (int c = 0; c < 3; ++c) {
      add(w.force[c]);
      add(w.torque[c]);
      add(w.point[c]);
      add(w.velocity[c]);
    }
    add(w.work);
  }
  return words;
}

RunOptions with_threads(int threads, const std::string& exchange = "put-flag") {
  RunOptions options;
  options.threads = threads;
  options.exchange = exchange;
  return options;
}

CheckpointSpec by_steps(std::int64_t every) {
  return {every, 0.0, 100000};
}

/// Runs to the end, saving at a given step if any; words of the middle and of the end.
struct Course {
  Words middle, end;
};

Course whole_run(const Scenario& s, MPI_Comm comm, const RunOptions& options, std::int64_t middle,
                 const std::string& folder) {
  Simulation sim(s.model, s.set, comm, options);
  if (!folder.empty()) sim.keep_checkpoints(folder, {});
  if (s.force) sim.apply_forces(s.force);
  sim.run(middle);
  Course run{words_of(sim), {}};
  if (!folder.empty()) sim.save_checkpoint();
  sim.run(s.num_steps - middle);
  EXPECT_TRUE(sim.finish_checkpoints());
  EXPECT_EQ(sim.take_checkpoint_warnings(), std::vector<std::string>{});
  run.end = words_of(sim);
  return run;
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

std::vector<Scenario> restart_scenarios() {
  return {soil_with_ring_and_plate(),
          column_collapse(),
          gas(2, {true, true, false}, 3.0, "2D gas, all periodic"),
          gas(3, {true, false, true}, 3.0, "3D gas, periodic"),
          moving_walls(),
          rough_bed(),
          pushed_by_caller(),
          breaking_plate(2),
          with_skin(breaking_plate(3), 0.04),
          with_skin(expansion(), 0.04),
          two_particles(true),
          many_laws(3, true),
          strips_along_y()};
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
    if (writers > world_size()) continue;
    {
      const FirstRanks ranks(writers);
      if (ranks.has_me()) {
        const Course run =
            whole_run(scenario_, ranks.get(), with_threads(1 + writers % 2), middle, folder.path());
        EXPECT_EQ(run.end, expected.end) << writers << " ranks, not restarted";
      }
    }
    for (const int readers : {1, 2, 4}) {
      if (readers > world_size()) continue;
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

INSTANTIATE_TEST_SUITE_P(Scenarios, RestartOf, testing::Range(0, 13));

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

TEST(Checkpoints, AreKeptAsManyAsAskedFor) {
  const Scenario s = moving_walls();
  const SharedFolder folder;
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  sim.keep_checkpoints(folder.path(), {20, 0.0, 2});
  sim.run(130);
  EXPECT_TRUE(sim.finish_checkpoints());
  EXPECT_EQ(CheckpointFolder(folder.path()).steps(), (std::vector<std::int64_t>{120, 100}));

  EXPECT_EQ(sim.last_checkpoint(), sim.communicator().is_root() ? folder.at(120) : "");
}

TEST(Checkpoints, ComeOnRequestOnce) {
  const Scenario s = moving_walls();
  const SharedFolder folder;
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  sim.keep_checkpoints(folder.path(), {0, 0.0, 9});
  sim.run(100);
  if (sim.communicator().is_root()) Simulation::request_checkpoint();
  sim.run(100);
  EXPECT_TRUE(sim.finish_checkpoints());
  const auto steps = CheckpointFolder(folder.path()).steps();
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_GT(steps[0], 100);
  EXPECT_LT(steps[0], 125);
}

TEST(Checkpoints, ComeByTheClock) {
  const Scenario s = moving_walls();
  const SharedFolder folder;
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  sim.keep_checkpoints(folder.path(), {0, 1e-6, 3});
  sim.run(200);
  EXPECT_TRUE(sim.finish_checkpoints());
  EXPECT_EQ(CheckpointFolder(folder.path()).steps().size(), 3U);
}

TEST(Checkpoints, ThatCannotBeWrittenAreWarningsAndTheRunGoesOn) {
  const Scenario s = moving_walls();
  const SharedFolder folder;
  const bool is_root = rank_of(MPI_COMM_WORLD) == 0;
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  sim.keep_checkpoints(folder.path() + "/sub", {50, 0.0, 2});
  sim.run(60);
  EXPECT_TRUE(sim.finish_checkpoints());
  if (is_root) {  // a file where the next one's folder should be
    fs::create_directories(folder.path() + "/sub");
    std::ofstream(folder.path() + "/sub/step_000000100.part") << "in the way";
  }
  MPI_Barrier(MPI_COMM_WORLD);
  sim.run(60);
  EXPECT_FALSE(sim.finish_checkpoints());
  const auto warnings = sim.take_checkpoint_warnings();
  ASSERT_EQ(warnings.size(), is_root ? 1U : 0U);
  if (is_root) {
    EXPECT_NE(warnings[0].find("step 100"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[0].find("step_000000050, stays"), std::string::npos) << warnings[0];
  }
  const Communicator world = Communicator::world();
  EXPECT_EQ(find_checkpoint(world, folder.path() + "/sub")->step, 50);
}

TEST(Checkpoints, AreFoundNewestFirstAndDamagedOnesAreSkippedWithReasons) {
  const Scenario s = moving_walls();
  const SharedFolder folder;
  const Communicator world = Communicator::world();
  EXPECT_FALSE(find_checkpoint(world, folder.path()).has_value());
  const Course expected = [&] {
    Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
    sim.keep_checkpoints(folder.path() + "/checkpoints", {50, 0.0, 10});
    sim.run(s.num_steps);
    EXPECT_TRUE(sim.finish_checkpoints());
    return Course{{}, words_of(sim)};
  }();
  if (world.is_root()) {
    const CheckpointFolder inner(folder.path() + "/checkpoints");
    fs::resize_file(inner.complete(350) + "/rank_00000.bin", 100);
    fs::remove(inner.complete(300) + "/" +
               rank_file_name(static_cast<std::size_t>(world.size() - 1)));
    std::ofstream(inner.complete(250) + "/manifest.json", std::ios::app) << " ";
    fs::copy_file(inner.complete(150) + "/rank_00000.bin", inner.complete(200) + "/rank_00000.bin",
                  fs::copy_options::overwrite_existing);
    fs::create_directories(inner.unfinished(400));
  }
  world.barrier();
  const auto choice = find_checkpoint(world, folder.path());
  ASSERT_TRUE(choice.has_value());
  EXPECT_EQ(choice->step, 150);
  EXPECT_EQ(choice->skipped.size(), 4U);
  EXPECT_THROW((void)find_checkpoint(world, folder.path() + "/checkpoints/step_000000300"),
               InputError);
  EXPECT_THROW((void)Simulation::restore(s.model, folder.path() + "/checkpoints/step_000000200",
                                         MPI_COMM_WORLD),
               InputError);

  Simulation sim = Simulation::restore(s.model, choice->path, MPI_COMM_WORLD, with_threads(1));
  sim.keep_checkpoints(folder.path() + "/checkpoints", {50, 0.0, 3});
  sim.run(s.num_steps - sim.step());
  EXPECT_TRUE(sim.finish_checkpoints());
  EXPECT_EQ(words_of(sim), expected.end);
  EXPECT_EQ(CheckpointFolder(folder.path() + "/checkpoints").steps(),
            (std::vector<std::int64_t>{350, 300, 250}));
  EXPECT_EQ(find_checkpoint(world, folder.path())->skipped.size(), 0U);
}

TEST(Checkpoints, AreFoundThatAnEndedRunWasAboutToReplace) {
  const Scenario s = moving_walls();
  const SharedFolder folder;
  const Communicator world = Communicator::world();
  (void)whole_run(s, MPI_COMM_WORLD, with_threads(1), 100, folder.path());
  if (world.is_root()) fs::rename(folder.at(100), folder.at(100) + ".old");
  world.barrier();

  const auto choice = find_checkpoint(world, folder.path());

  ASSERT_TRUE(choice.has_value());
  EXPECT_EQ(choice->path, folder.at(100));
}

TEST(Restart, RefusesAnotherDeckAndSaysWhatDiffers) {
  Scenario s = moving_walls();
  const SharedFolder folder;
  (void)whole_run(s, MPI_COMM_WORLD, with_threads(1), 100, folder.path());
  s.model.time.num_steps = 12345;
  s.model.title = "longer";
  EXPECT_NO_THROW((void)Simulation::restore(s.model, folder.at(100), MPI_COMM_WORLD));
  s.model.gravity[1] = -1.0;
  s.model.contacts.constants[0].mu = 0.1;
  try {
    (void)Simulation::restore(s.model, folder.at(100), MPI_COMM_WORLD);
    FAIL() << "another deck was taken";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("gravity, contact and pair"), std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace barchan::test
