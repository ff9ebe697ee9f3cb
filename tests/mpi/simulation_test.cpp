// The same bits for any number of ranks and threads, any exchange, schedule, contact search and
// vector width: every variant is compared with one rank and one thread, computed by rank 0 on a
// communicator of its own.
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/kernels/kernel_set.hpp>
#include <barchan/tasks/forecast.hpp>
#include <barchan/tasks/strip_plan.hpp>

#include "law_scenarios.hpp"
#include "running.hpp"

namespace barchan::test {
namespace {

/// What a run leaves behind: words that must all be equal.
struct Outcome {
  std::vector<std::uint64_t> words;
  std::int64_t migrations = 0, contacts = 0, broken = 0;

  void add(double value) { words.push_back(std::bit_cast<std::uint64_t>(value)); }
};

/// Runs in `pieces`, measuring between them, which must not change a bit.
Outcome outcome_of(const Scenario& s, MPI_Comm comm, const RunOptions& options, int pieces) {
  constexpr std::int64_t kForceEvery = 50;
  Simulation sim(s.model, s.set, comm, options);
  std::int64_t done = 0;
  for (int piece = 1; piece <= pieces; ++piece) {
    const std::int64_t until = s.num_steps * piece / pieces / kForceEvery * kForceEvery;
    while (done < until) {
      if (s.force) sim.apply_forces(s.force);
      done += sim.run(std::min(s.force ? kForceEvery : until, until - done));
    }
    if (piece < pieces) (void)sim.measure();
  }
  const Measures m = sim.measure();
  Outcome out;
  out.words = {sim.digest(), static_cast<std::uint64_t>(m.contacts),
               static_cast<std::uint64_t>(m.bonds), static_cast<std::uint64_t>(m.broken_bonds)};
  for (const double value :
       {m.kinetic.value(), m.elastic.value(), m.gravitational.value(), m.max_overlap, m.max_speed,
        m.momentum[0].value(), m.momentum[1].value(), m.momentum[2].value()}) {
    out.add(value);
  }
  for (const WallState& w : sim.walls()) {
    for (int c = 0; c < 3; ++c) {
      out.add(w.force[c]);
      out.add(w.torque[c]);
      out.add(w.point[c]);
    }
    out.add(w.work);
    out.add(w.heat_flow);
  }
  if (s.model.heat.is_on) {
    for (const double value : {m.heat.value(), m.min_temperature, m.max_temperature})
      out.add(value);
  }
  if (s.model.output.energy) {
    const EnergyBudget b = sim.energy_budget(m);
    for (const double value :
         {b.contact_loss, b.dashpot_loss, b.sliding_loss, b.rolling_loss, b.error})
      out.add(value);
  }
  std::int64_t migrations = sim.timings().migrations;
  MPI_Allreduce(&migrations, &out.migrations, 1, MPI_INT64_T, MPI_SUM, comm);
  out.contacts = m.contacts;
  out.broken = m.broken_bonds;
  return out;
}

/// The reference, on every rank.
Outcome reference_of(const Scenario& s) {
  Outcome out;
  if (is_root()) {
    RunOptions options;
    options.threads = 1;
    options.vector = "scalar";
    out = outcome_of(s, MPI_COMM_SELF, options, 1);
  }
  std::array<std::int64_t, 3> head{static_cast<std::int64_t>(out.words.size()), out.contacts,
                                   out.broken};
  MPI_Bcast(head.data(), 3, MPI_INT64_T, 0, MPI_COMM_WORLD);
  out.words.resize(static_cast<std::size_t>(head[0]));
  out.contacts = head[1];
  out.broken = head[2];
  MPI_Bcast(out.words.data(), static_cast<int>(head[0]), MPI_UINT64_T, 0, MPI_COMM_WORLD);
  return out;
}

/// Bricks along several axes, taking turns, where they fit; empty: as the run likes it.
std::string cuts_for(const Scenario& s, unsigned turn) {
  const int n = num_ranks();
  const std::array<std::string, 4> all{"", fmt::format("1,{}", n),
                                       n % 2 == 0 ? fmt::format("2,{}", n / 2) : "",
                                       s.model.dimension == 3 ? fmt::format("1,1,{}", n) : ""};
  const std::string& cuts = all[turn % all.size()];
  if (cuts.empty()) return cuts;
  try {
    (void)choose_cuts({parse_cuts(cuts), n, 1, false, {}}, plan_cuts(s.model, s.set).room);
  } catch (const InputError&) {
    return "";
  }
  return cuts;
}

/// Of shadows, where so many fit: 0, 1 or 3.
int depth_for(const Scenario& s, const RunOptions& o, unsigned turn) {
  constexpr std::array<int, 3> kDepths{1, 3, 0};
  int depth = kDepths[turn % kDepths.size()];
  if (o.exchange == "return" || !o.cuts.empty() || num_ranks() == 1) return 0;
  // Which makes a window for each message that may be under way: on many ranks that takes long.
  if (o.exchange.find("pscw") != std::string::npos) depth = std::min(depth, 1);
  const CutRoom room = plan_cuts(s.model, s.set).room;
  for (; depth > 0; --depth) {
    try {
      (void)choose_cuts({{}, num_ranks(), 1, false, {}, depth, {}}, room);
      break;
    } catch (const InputError&) {
    }
  }
  return depth;
}

/// All are tried on two ranks; a half, drawn by the number of the variant, on three and four; a
/// third on one rank, where nothing is sent. BARCHAN_TEST_ALL=1 tries all.
bool is_tried(unsigned number) {
  static const bool is_all = std::getenv("BARCHAN_TEST_ALL") != nullptr;
  const unsigned every = num_ranks() == 1 ? 3 : num_ranks() == 2 ? 1 : 2;
  const unsigned draw = 2654435761u * number >> 27;  // Knuth's multiplicative hash
  return is_all || draw % every == static_cast<unsigned>(num_ranks()) % every;
}

/// One run for each exchange that is tried; everything else takes turns, so that all pairs of
/// choices meet over the scenarios.
std::vector<RunOptions> variants(const Scenario& s, unsigned turn) {
  auto exchanges = exchange_choices();
  const std::array<const char*, 3> mixes{"shared+put-inband", "put-flag+isend", "shared+sendrecv"};
  exchanges.emplace_back(mixes[turn % mixes.size()]);
  const auto widths = vector_widths();
  std::vector<RunOptions> all;
  for (std::size_t e = 0; e < exchanges.size(); ++e) {
    const auto q = static_cast<unsigned>(e) + turn;
    if (!is_tried(q)) continue;
    RunOptions o;
    o.exchange = exchanges[e];
    if (o.exchange != "return") o.cuts = cuts_for(s, q + turn / 2);
    o.threads = 1 + static_cast<int>((q + turn / 3) % 3);
    o.schedule = q % 2 == 0 ? Schedule::Overlap : Schedule::Sequential;
    o.search = (q / 2) % 2 == 0 ? ContactSearchKind::Cells : ContactSearchKind::AllPairs;
    o.vector = name_of(widths[(q + turn / 2) % widths.size()]);
    o.hooks.max_delay_seconds = (q / 3) % 2 == 0 ? 1e-4 : 0.0;
    o.hooks.delay_seed = 17 * q + 1;
    o.progress = q % 4 == 1 ? Progress::Thread : Progress::Poll;
    o.hooks.ranks_per_node = 2;
    o.depth = depth_for(s, o, q + turn / 4);
    o.hooks.compare_shadows = true;
    all.push_back(o);
  }
  return all;
}

std::string describe(const RunOptions& o) {
  return fmt::format(
      "{} ranks, cuts '{}', depth {}, exchange {}, {} threads, {}{}, {}, {}, delays up to {} s",
      num_ranks(), o.cuts, o.depth.value_or(0), o.exchange, o.threads,
      o.schedule == Schedule::Overlap ? "overlap" : "sequential",
      o.progress == Progress::Thread ? " by a thread" : "",
      o.search == ContactSearchKind::Cells ? "cells" : "all-pairs", o.vector,
      o.hooks.max_delay_seconds);
}

/// The same particles in another order, with lists of another reach, which are made anew at other
/// steps: all nobody's bit.
void expect_same_bits_with_any_lists(const Scenario& s, const Outcome& reference, unsigned turn) {
  constexpr std::array<double, 3> kFactors{1.3, 1.0, 1.7};
  constexpr std::array<int, 4> kEvery{0, 1, 5, 3};
  const auto options = variants(s, turn);
  for (unsigned q = 0; q < 2; ++q) {
    RunOptions o = options[(turn + 3 * q) % options.size()];
    o.hooks.rebuild_every = kEvery[(turn + q) % kEvery.size()];
    Scenario other = s;
    const double skin = s.model.search.skin.value_or(default_skin(s.model, s.set));
    other.model.search.skin = kFactors[(turn / 2 + 2 * q) % kFactors.size()] * skin;
    std::shuffle(other.set.particles.begin(), other.set.particles.end(), std::mt19937_64(turn + q));
    const Outcome got = outcome_of(other, MPI_COMM_WORLD, o, 2);
    EXPECT_EQ(got.words, reference.words)
        << s.name << ": " << describe(o) << ", skin " << *other.model.search.skin << " for " << skin
        << ", lists anew every " << o.hooks.rebuild_every << " steps, shuffled";
  }
}

Outcome expect_same_bits(const Scenario& s, unsigned turn) {
  const Outcome reference = reference_of(s);
  expect_same_bits_with_any_lists(s, reference, turn);
  std::int64_t migrations = 0;  // none where cuts lie along what moves
  for (const RunOptions& o : variants(s, turn)) {
    const Outcome got = outcome_of(s, MPI_COMM_WORLD, o, 2);
    EXPECT_EQ(got.words, reference.words) << s.name << ": " << describe(o);
    migrations += got.migrations;
  }
  if (s.must_migrate && num_ranks() > 1) {
    EXPECT_GT(migrations, 0) << s.name;
  }
  return reference;
}

TEST(SameBits, SoilWithBondedRingUnderLoadedPlate) {
  EXPECT_GT(expect_same_bits(soil_with_ring_and_plate(), 0).contacts, 150);
}

TEST(SameBits, ColumnCollapseIn3D) {
  EXPECT_GT(expect_same_bits(column_collapse(), 1).contacts, 30);
}

TEST(SameBits, ShearFlowAroundThePeriodicEnd) {
  EXPECT_GT(expect_same_bits(shear_flow(), 2).contacts, 50);
}

TEST(SameBits, GasPeriodicAlongTheStrips) {
  (void)expect_same_bits(gas(2, {true, false, false}, 6.0, "gas, periodic x"), 3);
}

TEST(SameBits, GasPeriodicAcrossTheStrips) {
  (void)expect_same_bits(gas(2, {false, true, false}, 6.0, "gas, periodic y"), 4);
}

TEST(SameBits, GasPeriodicBothWaysWithStripsAlongY) {
  (void)expect_same_bits(strips_along_y(), 5);
}

TEST(SameBits, GasInACornerOfAVastDomain) {
  (void)expect_same_bits(gas_in_a_corner(), 9);
}

TEST(SameBits, GasIn3DPeriodicAllAround) {
  (void)expect_same_bits(gas(3, {true, true, true}, 6.0, "3D gas, periodic"), 6);
}

TEST(SameBits, GasIn3DPeriodicAcrossTheStrips) {
  (void)expect_same_bits(gas(3, {false, true, false}, 6.0, "3D gas, periodic y"), 7);
}

TEST(SameBits, CloudExpandingIntoEmptyStripsWhileCutsMove) {
  (void)expect_same_bits(expansion(), 8);
}

/// A cloud goes around the end of a periodic box and leaves but few at rest far behind. A cut leaps
/// back over all that is empty; from where its strip is then, the shorter way to what it passed is
/// the wrong one, around the end. With one column at rest this happens to four strips, with two to
/// three.
Scenario cloud_around_the_end(int columns_at_rest) {
  Scenario s{"a cloud goes around the end", plain_model(2, 6.0, 0.4), {}, 160, {}, true};
  s.model.domain.periodic[0] = true;
  add_box_walls(s.model);
  add_cloud(s.set, 2, {{4.2, 0.0, 0.0}, {6.0, 0.4, 0.0}, 0.18, 0.055, 0.5, 1});
  for (ParticleData& p : s.set.particles) p.velocity[0] += 8.0;
  const double end = 1.95 + 0.1 * columns_at_rest;
  add_cloud(s.set, 2, {{1.9, 0.0, 0.0}, {end, 0.4, 0.0}, 0.1, 0.05, 0.0, 13});
  shuffle_ids(s.set, 11);
  return s;
}

TEST(SameBits, CloudAroundThePeriodicEndWhileCutsMoveFar) {
  // Ranks of one to three lanes make three strips, or four.
  (void)expect_same_bits(cloud_around_the_end(num_ranks() % 2 == 0 ? 1 : 2), 19);
}

TEST(SameBits, AllParticlesInOneSlab) {
  (void)expect_same_bits(one_slab(), 9);
}

TEST(SameBits, FewerParticlesThanRanks) {
  (void)expect_same_bits(two_particles(false), 10);
  (void)expect_same_bits(two_particles(true), 11);
}

TEST(SameBits, MovingWalls) {
  (void)expect_same_bits(moving_walls(), 12);
}

TEST(SameBits, PlatesThatGoThroughPeriodicBorders) {
  (void)expect_same_bits(plates_at_borders(), 20);
}

TEST(SameBits, FreeParticlesOnFixedOnesWithMassDependentDamping) {
  (void)expect_same_bits(rough_bed(), 13);
}

TEST(SameBits, ForcesOfTheCallerMoveWithTheirParticles) {
  (void)expect_same_bits(pushed_by_caller(), 14);
}

TEST(SameBits, BondsBreakingAtCuts) {
  EXPECT_GT(expect_same_bits(breaking_plate(2), 15).broken, 10);
}

TEST(SameBits, BondsBreakingAtCutsIn3DAroundThePeriodicEnd) {
  EXPECT_GT(expect_same_bits(breaking_plate(3), 16).broken, 10);
}

TEST(SameBits, BondsAcrossGapsThatAreStressedAtTheStart) {
  (void)expect_same_bits(stressed_net(2), 17);
  (void)expect_same_bits(stressed_net(3), 18);
}

TEST(SameBits, MoreLawsThanAVectorHolds) {
  (void)expect_same_bits(many_laws(5, true), 17);
}

TEST(SameBits, TensionAllowedWithFewLaws) {
  (void)expect_same_bits(many_laws(2, false), 18);
}

TEST(SameBits, ElasticSpheresThatCollapseAndPile) {
  EXPECT_GT(expect_same_bits(hertz_column(), 3).contacts, 30);
}

TEST(SameBits, DisksThatResistToRolling) {
  EXPECT_GT(expect_same_bits(rolling_shear_flow(), 4).contacts, 50);
}

TEST(SameBits, DisksAsStiffAsTheirRadiiMakeThem) {
  EXPECT_GT(expect_same_bits(shear_flow_by_radius(), 5).contacts, 50);
}

TEST(SameBits, SpheresThatResistToRollingAndTwisting) {
  EXPECT_GT(expect_same_bits(rolling_column(), 6).contacts, 30);
  (void)expect_same_bits(rolling_hertz_gas(), 9);
}

TEST(SameBits, SpheresThatStick) {
  (void)expect_same_bits(sticky_gas(Adhesion::Dmt, true), 10);
  (void)expect_same_bits(sticky_gas(Adhesion::Sjkr, false), 12);
}

TEST(SameBits, SpheresThatHoldBeyondTouch) {
  (void)expect_same_bits(attracting_gas(false), 10);
  (void)expect_same_bits(sticky_gas(Adhesion::Bridge, true), 10);
}

TEST(SameBits, HeatThatFlowsAcrossCutsAndMovesWithItsParticlesAndWhatContactsLose) {
  (void)expect_same_bits(with_heat(plates_at_borders(), 400.0), 3);
  (void)expect_same_bits(with_heat(attracting_gas(true), 200.0), 7);
}

TEST(SameBits, ElasticSpheresThatMeetAtCuts) {
  (void)expect_same_bits(hertz_gas(), 8);
}

}  // namespace
}  // namespace barchan::test
