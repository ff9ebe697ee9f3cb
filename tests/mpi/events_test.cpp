// Callbacks within run(): when they come, what they may do, and how they end a run on all ranks.
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <barchan/core/base/error.hpp>

#include "coupling.hpp"

namespace barchan::test {
namespace {

constexpr int kEvery = 4;

void load(const ParticleView& view) {
  const auto v = view.velocities();
  const LoadView loads = view.loads();
  for (std::size_t i = 0; i < v.size(); ++i)
    loads.set(i, drag(v[i][0], v[i][1], v.width() == 3 ? v[i][2] : 0.0));
}

Words between_runs(const Scenario& s) {
  Simulation sim(s.model, s.set, MPI_COMM_SELF, with_threads(1));
  for (std::int64_t k = 0; k < s.num_steps; k += kEvery) {
    sim.for_each_view(load);
    sim.run(kEvery);
  }
  return words_of(sim);
}

TEST(Events, LoadsOfOnStepActAsThoseBetweenRuns) {
  for (const int dimension : {2, 3}) {
    const Scenario s = dragged(dimension);
    const Words expected = between_runs(s);
    for (const int threads : {1, 2}) {
      Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(threads));
      std::atomic<int> told = 0;
      sim.on_step(kEvery, [&](const ParticleView& view) {
        ++told;
        load(view);
      });
      sim.run(50);  // its length shows nowhere
      sim.run(s.num_steps - 50);
      EXPECT_EQ(words_of(sim), expected);
      EXPECT_EQ(told, sim.num_bricks() * s.num_steps / kEvery);

      Simulation other(s.model, s.set, MPI_COMM_WORLD, with_threads(threads));
      other.on_step_together(kEvery, [&](std::span<const ParticleView> views) {
        EXPECT_EQ(views.size(), static_cast<std::size_t>(other.num_bricks()));
        for (const ParticleView& view : views) load(view);
      });
      other.run(s.num_steps);
      EXPECT_EQ(words_of(other), expected);
    }
  }
}

TEST(Events, ProgressComesOnEveryRank) {
  const Scenario s = dragged(2);
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  std::vector<std::int64_t> steps;
  sim.on_progress(7, [&](const RunProgress& now) {
    EXPECT_EQ(now.time, sim.time());
    steps.push_back(now.step);
  });
  sim.run(20);
  sim.run(1);
  EXPECT_EQ(steps, (std::vector<std::int64_t>{7, 14, 21}));
  sim.on_progress(1, {});
  sim.run(7);
  EXPECT_EQ(steps.size(), 3U);
}

std::vector<std::tuple<std::int64_t, std::int64_t, std::int64_t>> breaks_of(const Scenario& s,
                                                                            MPI_Comm comm,
                                                                            int threads) {
  Simulation sim(s.model, s.set, comm, with_threads(threads));
  std::vector<std::tuple<std::int64_t, std::int64_t, std::int64_t>> breaks;
  sim.on_bond_breaks([&](std::span<const BondBreak> told) {
    for (const BondBreak& b : told) breaks.emplace_back(b.step, b.id_a, b.id_b);
  });
  const State start = sim.save();
  sim.run(s.num_steps / 2);
  sim.load(start);
  breaks.clear();
  sim.run(s.num_steps);
  const std::int64_t broken = sim.measure().broken_bonds;
  EXPECT_GT(broken, 0);
  EXPECT_TRUE(!sim.communicator().is_root() || breaks.size() == static_cast<std::size_t>(broken));
  EXPECT_TRUE(std::is_sorted(breaks.begin(), breaks.end()));
  return breaks;
}

TEST(Events, BreaksOfBondsAreTheSameOnAnyRanks) {
  for (const int dimension : {2, 3}) {
    const Scenario s = breaking_plate(dimension);
    const auto expected = breaks_of(s, MPI_COMM_SELF, 1);
    for (const int threads : {1, 2}) {
      const auto found = breaks_of(s, MPI_COMM_WORLD, threads);
      EXPECT_TRUE(!is_root() || found == expected);
    }
  }
}

TEST(Events, TellOfCheckpointsAndNotes) {
  const SharedFolder folder;
  Scenario s = two_particles(false);
  s.model.domain.outside = OutsidePolicy::Delete;
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  std::vector<std::string> notes, folders;
  sim.on_note([&](const Note& note) { notes.push_back(note.text); });
  sim.on_checkpoint([&](const CheckpointEvent& event) {
    EXPECT_EQ(event.error, "");
    folders.push_back(event.folder);
  });
  sim.keep_checkpoints(folder.path(), {});
  sim.save_checkpoint();
  EXPECT_TRUE(sim.finish_checkpoints());
  sim.run(6000);
  if (!is_root()) return;
  EXPECT_EQ(folders, std::vector<std::string>{folder.at(0)});
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& text) {
    return text.find("left the domain") != std::string::npos;
  }));
  EXPECT_TRUE(sim.take_notes().empty());
}

/// What ends run() where the last rank's callback throws.
template <class Register>
std::string words_of_end(const Scenario& s, Register&& make) {
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(2));
  const State start = sim.save();
  make(sim);
  const std::string words = words_thrown<AgreedError>([&] { sim.run(s.num_steps); });
  EXPECT_EQ(words_thrown<AgreedError>([&] { sim.run(1); }), words);
  (void)sim.measure();  // the state can be read
  sim.on_step(1, {});
  sim.on_progress(1, {});
  sim.on_note({});
  sim.on_bond_breaks({});
  sim.load(start);  // and the run go on from another one
  EXPECT_EQ(sim.run(3), 3);
  return words;
}

TEST(Events, AnExceptionEndsTheRunOnAllRanksAlike) {
  const int last = num_ranks() - 1;
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const auto boom = [&] {
    if (rank == last) throw std::out_of_range("boom");
  };
  const std::string from = "rank " + std::to_string(last) + ": boom";
  const Scenario s = breaking_plate(2);
  expect_words(words_of_end(s,
                            [&](Simulation& sim) {
                              sim.on_step(20, [&](const ParticleView&) {
                                if (sim.step() == 40) boom();
                              });
                            }),
               "step 40: on_step, " + from);
  expect_words(
      words_of_end(
          s, [&](Simulation& sim) { sim.on_progress(9, [&](const RunProgress&) { boom(); }); }),
      "step 9: on_progress, " + from);
  const std::string root = words_of_end(s, [&](Simulation& sim) {
    sim.on_bond_breaks([](std::span<const BondBreak>) { throw 7; });  // whatever it is
  });
  expect_words(root, "rank 0: an exception of unknown kind");
}

TEST(Events, OfDeparturesEndTheRunOnAllRanksAlike) {
  Scenario s = two_particles(false);
  s.model.domain.outside = OutsidePolicy::Delete;
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  sim.on_departure([](std::span<const Departure>) { throw std::runtime_error("no way out"); });
  const std::string words = words_thrown<AgreedError>([&] { sim.run(6000); });
  expect_words(words, "on_departure, rank 0: no way out");
  EXPECT_EQ(sim.measure().contacts, 0);
}

TEST(Events, CallbacksMayReadAndLoadAndNothingElse) {
  const Scenario s = dragged(2);
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(2));
  sim.add_field("dose");
  const State state = sim.save();
  const auto refused = [](auto&& call) {
    expect_words(words_thrown<std::logic_error>(call), "from within run()");
  };
  sim.on_progress(8, [&](const RunProgress&) {
    EXPECT_EQ(sim.owned().size(), sim.loads().size());
    *sim.field("dose")[0].values()[0] += 1.0;
    sim.owned()[0].loads().set(0, Vec3(1.0, 0.0, 0.0));
    refused([&] { sim.run(1); });
    refused([&] { (void)sim.measure(); });
    refused([&] { (void)sim.gather("dose"); });
    refused([&] { sim.add({}); });
    refused([&] { sim.load(state); });
    refused([&] { sim.on_note({}); });
  });
  sim.on_step(8, [&](const ParticleView& view) {
    *view.field("dose")[0] += 1.0;
    refused([&] { (void)sim.owned(); });
    refused([&] { (void)sim.loads(); });
  });
  EXPECT_EQ(sim.run(16), 16);
  std::int64_t calls = 2 * (sim.num_bricks() + 1);
  sim.communicator().allreduce_sum(std::span(&calls, 1));
  const Gathered doses = sim.gather("dose");
  const double sum = std::accumulate(doses.values.begin(), doses.values.end(), 0.0);
  EXPECT_TRUE(!is_root() || sum == static_cast<double>(calls));
}

TEST(Events, WrongRegistrationsAreRefused) {
  const Scenario s = dragged(2);
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  const auto nothing = [](const RunProgress&) {};
  expect_words(words_thrown<InputError>([&] { sim.on_progress(0, nothing); }), "every 0 steps");
  if (num_ranks() == 1) return;
  expect_words(words_thrown<InputError>([&] { sim.on_progress(is_root() ? 2 : 3, nothing); }),
               "ranks give different");
}

}  // namespace
}  // namespace barchan::test
