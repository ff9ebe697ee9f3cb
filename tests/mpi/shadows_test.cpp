// Shadows: slabs beyond the cuts are stepped here as well, so that halos may be late. What all
// models must keep with them is compared in simulation_test.cpp.
#include <gtest/gtest.h>
#include <mpi.h>

#include <string>
#include <vector>

#include <barchan/core/base/error.hpp>

#include "running.hpp"

namespace barchan::test {
namespace {

/// Wide enough for four strips with a depth of 5.
Scenario wide_gas(bool is_periodic) {
  return gas(2, {is_periodic, false, false}, 2.0, "gas");
}

std::string refusal(const Scenario& s, const RunOptions& options) {
  try {
    const Simulation sim(s.model, s.set, MPI_COMM_WORLD, options);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

std::uint64_t digest_after(const Scenario& s, const RunOptions& options, std::int64_t steps) {
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, options);
  sim.run(steps);
  return sim.digest();
}

RunOptions with_depth(int depth, const std::string& exchange = "put-inband") {
  RunOptions o = with_threads(1, exchange);
  o.depth = depth;
  o.hooks.compare_shadows = true;
  return o;
}

/// A rank does not wait for a message until so many more were sent than came: with messages that
/// take as long as some steps, the run takes turns of waiting and working in any order.
TEST(Shadows, GiveTheSameBitsAtAnyDepth) {
  const Scenario s = wide_gas(true);
  const std::uint64_t expected = digest_after(s, with_depth(0), 200);
  for (const int depth : {1, 2, 4}) {
    RunOptions o = with_depth(depth);
    o.hooks.max_delay_seconds = 2e-4;
    EXPECT_EQ(digest_after(s, o, 200), expected) << "depth " << depth;
  }
}

TEST(Shadows, AreRefusedWhereHalosCannotBeLate) {
  if (num_ranks() == 1) return;
  const Scenario s = wide_gas(false);
  RunOptions o = with_depth(1, "return");
  EXPECT_NE(refusal(s, o).find("exchange 'return' with a depth of 1"), std::string::npos)
      << refusal(s, o);
  o = with_depth(1);
  o.cuts = "1," + std::to_string(num_ranks());
  EXPECT_NE(refusal(s, o).find("works on strips"), std::string::npos) << refusal(s, o);
  o = with_depth(60);
  const std::string text = refusal(s, o);
  EXPECT_NE(text.find("a depth of 60 needs strips of 62 cells"), std::string::npos) << text;
  EXPECT_NE(text.find("use a depth of at most"), std::string::npos) << text;
}

/// They have a caller's forces as long as it gives them, and from then on none.
TEST(Shadows, FeelWhatACallerDoesBetweenSteps) {
  const Scenario s = wide_gas(true);
  const auto words = [&](int depth) {
    Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_depth(depth));
    const State start = sim.save();
    sim.apply_forces([](const OwnedParticle& p) { return Vec3(0.3 * p.mass, -2.0 * p.mass, 0.0); });
    sim.run(33);
    sim.clear_forces();
    sim.run(21);
    sim.set_gravity(Vec3(1.0, -3.0, 0.0));
    sim.run(10);
    const Words first = words_of(sim);
    sim.load(start);
    sim.run(40);
    Words all = words_of(sim);
    all.insert(all.end(), first.begin(), first.end());
    return all;
  };
  const Words expected = words(0);
  for (const int depth : {1, 3}) EXPECT_EQ(words(depth), expected) << "depth " << depth;
}

/// Walls that move fast, evaluated in steps that shadows take later than the lanes beside them.
TEST(Shadows, SeeWallsWhereTheyWereInTheirOwnStep) {
  Scenario s = wide_gas(false);
  for (WallSpec& wall : s.model.walls) wall.velocity = 0.5 * wall.normal;
  const std::uint64_t expected = digest_after(s, with_depth(0), 120);
  EXPECT_EQ(digest_after(s, with_depth(3), 120), expected);
}

TEST(Shadows, LetARunGoOnFromACheckpointAtAnotherDepth) {
  const Scenario s = soil_with_ring_and_plate();
  const SharedFolder folder;
  const Words expected = whole_run(s, MPI_COMM_WORLD, with_threads(1), 150, "").end;
  for (const auto& [before, after] : std::vector<std::pair<int, int>>{{0, 2}, {2, 1}}) {
    const RunOptions o = with_depth(before);
    EXPECT_EQ(whole_run(s, MPI_COMM_WORLD, o, 157, folder.path()).end, expected);
    Simulation sim =
        Simulation::restore(s.model, folder.at(157), MPI_COMM_WORLD, with_depth(after));
    if (s.force) sim.apply_forces(s.force);
    sim.run(s.num_steps - 157);
    EXPECT_EQ(words_of(sim), expected) << "depth " << before << ", then " << after;
  }
}

}  // namespace
}  // namespace barchan::test
