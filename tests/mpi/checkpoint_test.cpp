// When checkpoints are written, how many stay, and which one a run goes on from.
#include <gtest/gtest.h>
#include <mpi.h>

#include <filesystem>
#include <fstream>

#include <barchan/core/base/error.hpp>
#include <barchan/core/checkpoint/checkpoint_folder.hpp>
#include <barchan/tasks/checkpoint_load.hpp>

#include "running.hpp"
#include "scenarios.hpp"

namespace fs = std::filesystem;

namespace barchan::test {
namespace {

/// A run of moving walls on one thread a rank that keeps checkpoints as `spec` says.
struct KeepingRun {
  explicit KeepingRun(const CheckpointSpec& spec)
      : sim(scenario.model, scenario.set, MPI_COMM_WORLD, with_threads(1)) {
    sim.keep_checkpoints(folder.path(), spec);
  }
  /// Ends the writing; the steps of the checkpoints that there are, newest first.
  std::vector<std::int64_t> finish() {
    EXPECT_TRUE(sim.finish_checkpoints());
    return CheckpointFolder(folder.path()).steps();
  }

  SharedFolder folder;
  Scenario scenario = moving_walls();
  Simulation sim;
};

TEST(Checkpoints, AreKeptAsManyAsAskedFor) {
  KeepingRun run({.every_steps = 20, .every_seconds = 0.0, .keep = 2});
  run.sim.run(130);

  EXPECT_EQ(run.finish(), (std::vector<std::int64_t>{120, 100}));
  EXPECT_EQ(run.sim.last_checkpoint(), is_root() ? run.folder.at(120) : "");
}

TEST(Checkpoints, ComeOnRequestOnce) {
  KeepingRun run({.every_steps = 0, .every_seconds = 0.0, .keep = 9});
  run.sim.run(100);
  if (is_root()) Simulation::request_checkpoint();
  run.sim.run(100);

  const auto steps = run.finish();
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_GT(steps[0], 100);
  EXPECT_LT(steps[0], 125);
}

TEST(Checkpoints, ComeByTheClock) {
  KeepingRun run({.every_steps = 0, .every_seconds = 1e-6, .keep = 3});
  run.sim.run(200);

  EXPECT_EQ(run.finish().size(), 3U);
}

TEST(Checkpoints, ThatCannotBeWrittenAreWarningsAndTheRunGoesOn) {
  const Scenario s = moving_walls();
  const SharedFolder folder;
  const bool is_root = test::is_root();
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

TEST(Checkpoints, RefuseAnotherDeckAndSaysWhatDiffers) {
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

/// The next look tells of an overlap that was measured: also when the run was ended before it.
TEST(Checkpoints, RememberAnOverlapThatNoLookHasJudgedYet) {
  Scenario s = two_particles(false);
  s.model.search.skin.reset();
  s.model.contacts.constants[0].kn = 50.0;  // too soft for their speed
  s.model.limits = {0.05, 0.5};
  const SharedFolder folder;
  std::int64_t end = 0;
  {
    Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
    while (end < 1000 && sim.measure().max_overlap_share <= 0.5) end += sim.run(1);
  }
  {
    Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
    sim.keep_checkpoints(folder.path(), {.every_steps = 1000, .every_seconds = 0.0, .keep = 1});
    (void)sim.run(end);
    (void)sim.measure();
    sim.save_checkpoint();
    ASSERT_TRUE(sim.finish_checkpoints());
  }
  Simulation sim = Simulation::restore(s.model, folder.at(end), MPI_COMM_WORLD, with_threads(1));
  try {
    (void)sim.run(40);
    FAIL() << "an overlap measured at step " << end << " is forgotten";
  } catch (const AgreedError& e) {
    EXPECT_NE(std::string(e.what()).find("limits.overlap_error"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace barchan::test
