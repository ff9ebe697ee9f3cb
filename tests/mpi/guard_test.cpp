// What leaves the domain, what must not go wrong in silence, and buffers that must grow: the same
// verdict on every rank, and the bits of one rank.
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <barchan/comm/exchanges/make_exchange.hpp>
#include <barchan/core/base/error.hpp>

#include "running.hpp"
#include "scenarios.hpp"

namespace barchan::test {
namespace {

/// Whatever rank 0 has, on every rank.
Words from_root(Words words) {
  std::uint64_t size = words.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  words.resize(size);
  MPI_Bcast(words.data(), static_cast<int>(size), MPI_UINT64_T, 0, MPI_COMM_WORLD);
  return words;
}

/// State, counts, and on rank 0 the list of those that left.
Words outcome_of(const Scenario& s, MPI_Comm comm, const RunOptions& options) {
  Simulation sim(s.model, s.set, comm, options);
  Words departures;
  sim.on_departure([&](std::span<const Departure> left) {
    for (const Departure& d : left) {
      departures.insert(departures.end(),
                        {static_cast<std::uint64_t>(d.step), static_cast<std::uint64_t>(d.id),
                         std::bit_cast<std::uint64_t>(d.position[0]),
                         std::bit_cast<std::uint64_t>(d.velocity[1])});
    }
  });
  sim.run(s.num_steps);
  const Measures m = sim.measure();
  Words words{sim.digest(),
              static_cast<std::uint64_t>(sim.num_particles()),
              static_cast<std::uint64_t>(sim.left_domain().particles),
              static_cast<std::uint64_t>(sim.left_domain().links.contacts),
              static_cast<std::uint64_t>(sim.left_domain().links.wall_contacts),
              static_cast<std::uint64_t>(sim.left_domain().links.bonds),
              static_cast<std::uint64_t>(m.contacts),
              static_cast<std::uint64_t>(m.bonds),
              static_cast<std::uint64_t>(m.broken_bonds),
              std::bit_cast<std::uint64_t>(m.kinetic.value()),
              std::bit_cast<std::uint64_t>(m.elastic.value())};
  std::int64_t owned = sim.num_owned(), all = 0;
  MPI_Allreduce(&owned, &all, 1, MPI_INT64_T, MPI_SUM, comm);
  EXPECT_EQ(all, sim.num_particles());
  words.insert(words.end(), departures.begin(), departures.end());
  return words;
}

/// Every exchange, one to three threads; what rank 0 has must be that of one rank alone.
Words expect_same_outcome(const Scenario& s) {
  const Words expected =
      from_root(is_root() ? outcome_of(s, MPI_COMM_SELF, with_threads(1)) : Words{});
  int threads = 0;
  for (const std::string& exchange : exchange_choices()) {
    threads = threads % 3 + 1;
    const Words got = from_root(outcome_of(s, MPI_COMM_WORLD, with_threads(threads, exchange)));
    EXPECT_EQ(got, expected) << s.name << ", " << num_ranks() << " ranks of " << threads
                             << " threads, exchange " << exchange;
  }
  return expected;
}

/// A gas in an open box: it leaves on all sides.
Scenario open_gas(int dimension, std::array<bool, 3> periodic) {
  Scenario s = gas(dimension, periodic, 4.0, "gas in an open domain");
  s.model.walls.clear();
  s.model.domain.outside = OutsidePolicy::Delete;
  return s;
}

/// Bonded grains that are thrown out of an open box across several cuts.
Scenario bonded_and_open() {
  Scenario s = breaking_plate(2);
  s.name = "a bonded plate leaves the domain";
  s.model.walls.clear();
  s.model.domain.outside = OutsidePolicy::Delete;
  s.model.bond_laws = {weak_bond(5e3)};
  for (ParticleData& p : s.set.particles) p.velocity += Vec3(4.0, -4.0, 0.0);
  return s;
}

TEST(Outside, ParticlesThatLeaveAreRemovedAlikeOnAnyNumberOfRanks) {
  EXPECT_GT(expect_same_outcome(open_gas(2, {false, false, false}))[2], 20u);
  EXPECT_GT(expect_same_outcome(open_gas(2, {true, false, false}))[2], 10u);
  EXPECT_GT(expect_same_outcome(open_gas(3, {false, true, false}))[2], 10u);
}

TEST(Outside, BondsAndContactsOfWhatLeavesGoWithIt) {
  const Words end = expect_same_outcome(bonded_and_open());
  EXPECT_GT(end[2], 10u);  // particles
  EXPECT_GT(end[5], 10u);  // bonds
  EXPECT_GT(end[7], 0u);   // those that stay
}

TEST(Outside, TheLastParticleMayLeave) {
  Scenario s = two_particles(false);
  s.model.domain.outside = OutsidePolicy::Delete;
  s.num_steps = 6000;
  const Words end = expect_same_outcome(s);
  EXPECT_EQ(end[1], 0u);
  EXPECT_EQ(end[2], 2u);
}

TEST(Outside, NothingChangesWhereNothingLeaves) {
  Scenario kept = soil_with_ring_and_plate();
  kept.num_steps = 200;
  const auto digest = [&] {
    Simulation sim(kept.model, kept.set, MPI_COMM_WORLD, with_threads(2));
    sim.run(kept.num_steps);
    return sim.digest();
  };
  const std::uint64_t expected = digest();
  kept.model.domain.outside = OutsidePolicy::Delete;
  EXPECT_EQ(digest(), expected);
}

/// The error that a run ends with, on this rank; empty: none.
std::string error_of(const Scenario& s, const RunOptions& options, bool* can_go_on = nullptr) {
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, options);
  try {
    sim.run(s.num_steps);
  } catch (const AgreedError& e) {
    if (can_go_on != nullptr) *can_go_on = e.can_go_on();
    (void)sim.measure();  // all ranks are between the same two steps
    return e.what();
  }
  return {};
}

void expect_on_all_ranks(const std::string& error, std::initializer_list<const char*> parts) {
  for (const char* part : parts) EXPECT_NE(error.find(part), std::string::npos) << error;
  std::array<char, 1024> first{};
  std::copy_n(error.begin(), std::min(error.size(), first.size() - 1), first.begin());
  MPI_Bcast(first.data(), static_cast<int>(first.size()), MPI_CHAR, 0, MPI_COMM_WORLD);
  EXPECT_EQ(error.substr(0, first.size() - 1), std::string(first.data()));
}

TEST(Outside, IsAnErrorThatNamesTheParticleUnlessTheModelSaysOtherwise) {
  Scenario s = two_particles(false);
  s.num_steps = 6000;
  bool can_go_on = false;
  expect_on_all_ranks(
      error_of(s, with_threads(2), &can_go_on),
      {"particle ", " is out of the domain, at (", "velocity (", "domain.outside = \"delete\""});
  EXPECT_TRUE(can_go_on);
}

/// What every rank says when something was lost in the rebuild after a step.
void expect_loss_told(const Scenario& s, int threads, Loss what, std::int64_t step,
                      const char* told) {
  RunOptions options = with_threads(threads);
  options.hooks.loss = {what, step};
  expect_on_all_ranks(error_of(s, options), {told});
}

TEST(Balance, ALostParticleIsToldOnEveryRank) {
  expect_loss_told(soil_with_ring_and_plate(), 2, Loss::Particle, 50, "1 particle too few");
}

TEST(Balance, ALostContactIsToldOnEveryRank) {
  expect_loss_told(soil_with_ring_and_plate(), 1, Loss::Contact, 200, "1 contact too few");
}

TEST(Balance, ALostContactWithAWallIsToldOnEveryRank) {
  expect_loss_told(soil_with_ring_and_plate(), 1, Loss::WallContact, 200, "1 contact with a wall");
}

TEST(Balance, ALostBondIsToldOnEveryRank) {
  expect_loss_told(breaking_plate(2), 1, Loss::Bond, 50, "1 bond too few");
}

/// Notes of all ranks on rank 0.
std::string notes_of(const Scenario& s, const RunOptions& options, std::uint64_t& digest) {
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, options);
  sim.run(s.num_steps);
  digest = sim.digest();
  std::string text;
  for (const Note& note : sim.take_notes()) text += note.text + "\n";
  std::string all;
  for (const std::string& piece : sim.communicator().gather(text)) all += piece;
  return all;
}

Words digest_of_one_rank(const Scenario& s) {
  if (!is_root()) return {};
  Simulation sim(s.model, s.set, MPI_COMM_SELF, with_threads(1));
  sim.run(s.num_steps);
  return {sim.digest()};
}

void expect_growth(const Scenario& s, std::initializer_list<const char*> parts) {
  const Words expected = from_root(digest_of_one_rank(s));
  for (const std::string& exchange : exchange_names()) {
    std::uint64_t digest = 0;
    const std::string notes = notes_of(s, with_threads(2, exchange), digest);
    EXPECT_EQ(digest, expected[0]) << s.name << ", exchange " << exchange;
    if (!is_root() || num_ranks() == 1) continue;
    for (const char* part : parts)
      EXPECT_NE(notes.find(part), std::string::npos) << s.name << ", " << exchange << ":\n"
                                                     << notes;
  }
}

/// A thin stream that is stopped by a wall and piles up before it.
Scenario jet() {
  Scenario s{"a jet into one strip", plain_model(2, 8.0, 0.6), {}, 1200, {}, true};
  add_box_walls(s.model);
  s.model.search.skin = 0.15;
  add_cloud(s.set, 2, {{0.0, 0.0, 0.0}, {8.0, 0.6, 0.0}, 0.2, 0.05, 0.2, 31});
  for (ParticleData& p : s.set.particles) p.velocity[0] += 2.5 * (8.0 - p.position[0]);
  shuffle_ids(s.set, 10);
  return s;
}

/// All go to one end and leave the other strips empty.
Scenario flight_to_one_end() {
  Scenario s = jet();
  s.name = "all particles into one strip";
  s.num_steps = 1500;
  s.set = {};
  add_cloud(s.set, 2, {{0.0, 0.0, 0.0}, {8.0, 0.6, 0.0}, 0.3, 0.05, 0.2, 33});
  for (ParticleData& p : s.set.particles) p.velocity[0] = 3.0 * (8.0 - p.position[0]);
  return s;
}

TEST(Growth, AJetIntoOneStripMakesHalosAndListsGrowAndLosesNothing) {
  expect_growth(jet(), {"candidate pairs grow from"});
}

TEST(Growth, AllParticlesIntoOneStripMakeRowsGrowAndLoseNothing) {
  expect_growth(flight_to_one_end(), {"grow from"});
}

TEST(Watch, OverlapBeyondTheLimitEndsTheRunOnEveryRank) {
  Scenario s = two_particles(false);
  s.model.search.skin.reset();
  s.model.contacts.constants[0].kn = 50.0;  // too soft for their speed
  s.model.limits = {0.05, 0.5};
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  std::string error;
  std::vector<Note> notes;
  try {
    for (int piece = 0; piece < 100; ++piece) {
      sim.run(5);
      (void)sim.measure();
      for (Note& note : sim.take_notes()) notes.push_back(std::move(note));
    }
  } catch (const AgreedError& e) {
    error = e.what();
  }
  expect_on_all_ranks(error, {"limits.overlap_error = 0.5", "particle 3", "particle 7"});
  const auto warnings =
      std::count_if(notes.begin(), notes.end(), [](const Note& note) { return note.is_warning; });
  EXPECT_EQ(warnings, is_root() ? 1 : 0);
}

TEST(Watch, AWallThatAppearsInParticlesEndsTheRunInThatStep) {
  Scenario s = moving_walls();
  s.model.stages = {Stage{"wait", 0.0, 0.01}, Stage{"press", 0.0}};
  WallSpec& wall = s.model.walls.emplace_back();
  wall.name = "blade";
  wall.kind = WallKind::Plate;
  wall.point = Vec3(2.025, 0.3, 0.0);
  wall.normal = Vec3(1.0, 0.0, 0.0);
  wall.width = 0.6;
  wall.from_stage = 1;
  expect_on_all_ranks(
      error_of(s, with_threads(1)),
      {"at step 50 wall 'blade' appears with stage 'press'", "particle ", " wall 'blade'"});
}

TEST(Watch, AWallThatOutrunsTheSkinIsNoticed) {
  Scenario s = moving_walls();
  s.num_steps = 2000;
  s.model.gravity = Vec3::Zero();
  s.model.walls.push_back(loaded_plate(0.95, 0.5, 1e3, 0.01));  // faster than any check expects
  s.model.time.allow_unstable = true;
  expect_on_all_ranks(error_of(s, with_threads(1)), {"a particle or wall had moved", "the skin"});
}

TEST(Watch, APlateThatMayPassParticlesUnseenIsAnErrorBeforeThatStep) {
  Scenario s = moving_walls();
  s.model.walls.push_back(loaded_plate(0.95, 0.5, 5e4, 0.01));
  s.model.time.allow_unstable = true;
  expect_on_all_ranks(error_of(s, with_threads(1)),
                      {"wall 'plate' moves ", " m in one step", "smallest radius"});
}

}  // namespace
}  // namespace barchan::test
