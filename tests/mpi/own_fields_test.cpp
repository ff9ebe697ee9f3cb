// Fields of the caller's own: they stay with their particles, whatever happens to rows.
#include <gtest/gtest.h>
#include <mpi.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <barchan/core/base/error.hpp>

#include "coupling.hpp"

namespace barchan::test {
namespace {

double dose_of(std::int64_t id) {
  return 0.5 + 3.0 * static_cast<double>(id);
}

void set_doses(Simulation& sim) {
  const auto views = sim.owned();
  const auto doses = sim.field("dose");
  for (std::size_t b = 0; b < views.size(); ++b) {
    for (std::size_t i = 0; i < views[b].size(); ++i)
      *doses[b].values()[i] = dose_of(views[b].ids()[i]);
  }
}

/// Adds v·dt and the time, as a caller's own law would.
void expose(Simulation& sim) {
  const auto views = sim.owned();
  const auto paths = sim.field("path");
  for (std::size_t b = 0; b < views.size(); ++b) {
    const auto v = views[b].velocities();
    for (std::size_t i = 0; i < v.size(); ++i) {
      double* path = paths[b].values()[i];
      for (int c = 0; c < v.width(); ++c) path[c] += 1e-3 * v[i][c];
      path[3] += sim.time();
    }
  }
}

/// @return how many have a dose that is not of their id; zeros are of newcomers
int num_wrong(Simulation& sim) {
  int wrong = 0;
  const auto views = sim.owned();
  const auto doses = sim.field("dose");
  for (std::size_t b = 0; b < views.size(); ++b) {
    for (std::size_t i = 0; i < views[b].size(); ++i) {
      const double dose = *doses[b].values()[i];
      wrong += dose != 0.0 && dose != dose_of(views[b].ids()[i]) ? 1 : 0;
    }
  }
  return wrong;
}

/// On rank 0: the bits of both fields of all particles.
Words fields_of(Simulation& sim) {
  Words words;
  for (const char* name : {"dose", "path"}) {
    const Gathered all = sim.gather(name);
    for (const std::int64_t id : all.ids) words.push_back(static_cast<std::uint64_t>(id));
    for (const double value : all.values) words.push_back(std::bit_cast<std::uint64_t>(value));
  }
  return words;
}

/// Where there is room.
void come(Simulation& sim, const ParticleData& p) {
  try {
    sim.add(std::span(&p, 1));
  } catch (const InputError&) {
    return;
  }
}

/// Particles migrate, go, come back and are exposed; one excursion is taken back.
/// @param carries  with the fields; else the same course without
Words course(Simulation& sim, const ParticleData& back, bool carries) {
  if (carries) {
    EXPECT_TRUE(sim.add_field("dose"));
    set_doses(sim);
  }
  sim.run(40);
  State before = sim.save();  // of a time with one field
  if (carries) {
    EXPECT_TRUE(sim.add_field("path", 4));
    EXPECT_FALSE(sim.add_field("path", 4));
  }
  for (int k = 0; k < 5; ++k) {
    if (carries) expose(sim);
    sim.run(13);
    if (k == 1) {
      sim.load(before);
      if (carries) expose(sim);
    }
    if (k == 2) sim.remove(std::span(&back.id, 1));
    if (k == 3) come(sim, back);
  }
  if (!carries) return words_of(sim);
  EXPECT_EQ(num_wrong(sim), 0);
  const std::vector<std::int64_t> two{5, 9};
  const std::vector<double> values{1, 2, 3, 4, 5, 6, 7, 8};
  sim.scatter("path", two, values);
  return words_of(sim);
}

TEST(OwnFields, StayWithTheirParticlesAndChangeNoBit) {
  for (const Scenario& s : {dragged(2), dragged(3), breaking_plate(2)}) {
    SCOPED_TRACE(s.name);
    const ParticleData& back = s.set.particles[20];
    Words expected, fields;
    {
      Simulation alone(s.model, s.set, MPI_COMM_SELF, with_threads(1));
      expected = course(alone, back, true);
      fields = fields_of(alone);
      Simulation without(s.model, s.set, MPI_COMM_SELF, with_threads(1));
      EXPECT_EQ(course(without, back, false), expected);
    }
    for (const int threads : {1, 2}) {
      Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(threads));
      EXPECT_EQ(course(sim, back, true), expected);
      const Words found = fields_of(sim);
      EXPECT_TRUE(!is_root() || found == fields);
    }
  }
}

TEST(OwnFields, GoThroughCheckpointsToAnyRanks) {
  const Scenario s = dragged(2);
  SharedFolder folder;
  Words at_end, fields;
  {
    Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(2));
    sim.add_field("dose");
    sim.add_field("path", 4);
    set_doses(sim);
    sim.run(30);
    expose(sim);
    sim.keep_checkpoints(folder.path(), {});
    sim.save_checkpoint();
    EXPECT_TRUE(sim.finish_checkpoints());
    sim.run(30);
    at_end = words_of(sim);
    fields = fields_of(sim);
  }
  for (const MPI_Comm ranks : {MPI_COMM_WORLD, MPI_COMM_SELF}) {
    Simulation sim = Simulation::restore(s.model, folder.at(30), ranks, with_threads(1));
    ASSERT_EQ(sim.fields().size(), 2U);
    EXPECT_EQ(sim.fields()[1].name, "path");
    EXPECT_FALSE(sim.add_field("dose"));
    sim.run(30);
    EXPECT_EQ(words_of(sim), at_end);
    const Words found = fields_of(sim);
    EXPECT_TRUE(!is_root() || found == fields);
    EXPECT_EQ(num_wrong(sim), 0);
  }
}

TEST(OwnFields, CostNothingWhereThereAreNone) {
  const Scenario s = dragged(2);
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  const std::size_t before = sim.memory_bytes();
  EXPECT_TRUE(sim.fields().empty());
  sim.add_field("dose", 3);
  EXPECT_GE(sim.memory_bytes(), before + 24 * static_cast<std::size_t>(sim.num_owned()));
}

TEST(OwnFields, WrongCallsAreRefusedInWords) {
  const Scenario s = dragged(2);
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  sim.add_field("dose");
  const auto stale = sim.field("dose");
  const std::vector<std::int64_t> ids{1, 2}, unknown{1 << 30};
  const std::vector<double> one{1.0};
  const auto input = [](auto&& call) { return words_thrown<InputError>(call); };
  expect_words(input([&] { sim.add_field("my dose"); }), "'my dose' is no name");
  expect_words(input([&] { sim.add_field(std::string(44, 'a')); }), "at most 43");
  expect_words(input([&] { sim.add_field("none", 0); }), "give 1 or more");
  expect_words(input([&] { sim.add_field("dose", 2); }), "of 1 components, not 2");
  expect_words(input([&] { sim.add_field("many", 256); }), "at most 256 numbers");
  expect_words(input([&] { sim.scatter("dose", ids, one); }), "1 numbers for 2 particles");
  expect_words(input([&] { sim.scatter("dose", unknown, one); }), "no particle 1073741824");
  if (num_ranks() > 1) {
    expect_words(input([&] { sim.add_field(is_root() ? "a" : "b"); }), "ranks give different");
    expect_words(input([&] { sim.add_field("c", is_root() ? 1 : 2); }), "ranks give different");
  }
  EXPECT_EQ(sim.fields().size(), 1U);
  expect_words(words_thrown<std::invalid_argument>([&] { (void)sim.field("dosis"); }), "'dose'");
  sim.add_field("other");  // rows are wider now
  expect_words(words_thrown<StaleView>([&] { (void)stale[0].values(); }), "a field");
}

}  // namespace
}  // namespace barchan::test
