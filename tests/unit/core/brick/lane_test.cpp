#include <barchan/core/brick/lane.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <barchan/core/base/error.hpp>

#include <unit/core/lane_fixture.hpp>

namespace barchan::test {
namespace {

template <int Dim>
Domain long_box(bool is_periodic) {
  Domain domain;
  domain.hi = Vec3(14.0, 3.4, Dim == 3 ? 2.3 : 0.0);
  domain.periodic = {is_periodic, false, Dim == 3};
  return domain;
}

constexpr double kCutoff = 1.1, kSkin = 0.1;

template <int Dim>
void expect_history_kept(bool is_periodic) {
  const Domain domain = long_box<Dim>(is_periodic);
  const auto particles = random_particles(Dim, domain, Dim == 2 ? 120 : 220, 0.5, 5);
  World<Dim> world = world_of<Dim>(domain, kCutoff, kSkin, 200);
  ASSERT_EQ(world.grid.num_slabs(), 12);
  const std::vector<std::vector<int>> layouts{
      {0, 3, 6, 9, 12}, {0, 5, 8, 10, 12}, {0, 2, 5, 8, 12}, {0, 3, 6, 9, 12}};
  Lanes<Dim> lanes(world, layouts[0]);
  lanes.seed(particles);
  for (std::size_t round = 1; round < layouts.size(); ++round) {
    for (int n = 0; n < 3; ++n) lanes.step();
    bool before_agrees = false, after_agrees = false;
    const Springs before = lanes.springs(before_agrees);
    const std::uint64_t digest = lanes.digest();

    lanes.rebuild(layouts[round]);
    const Springs after = lanes.springs(after_agrees);

    EXPECT_GT(before.size(), 100U);
    EXPECT_TRUE(before_agrees);
    EXPECT_TRUE(after_agrees);
    EXPECT_EQ(after, before) << "round " << round;
    EXPECT_EQ(lanes.digest(), digest);
  }
}

TEST(Lane, RebuildKeepsEveryContactsHistoryWhenCutsMove) {
  for (const bool is_periodic : {false, true}) {
    expect_history_kept<2>(is_periodic);
    expect_history_kept<3>(is_periodic);
  }
}

// From the new strip, the shorter way round the box is not the one that particles went.
TEST(Lane, RebuildSendsParticlesToTheirSideWhenCutsMoveFarInAPeriodicBox) {
  Domain domain = long_box<2>(true);
  domain.hi[0] = 18.5;
  const auto particles = random_particles(2, domain, 160, 0.5, 9);
  World<2> world = world_of<2>(domain, kCutoff, kSkin, 200);
  ASSERT_EQ(world.grid.num_slabs(), 16);
  const std::vector<std::vector<int>> layouts{
      {0, 2, 10, 16}, {0, 9, 14, 16}, {0, 2, 10, 16}, {0, 6, 14, 16}, {0, 2, 7, 16}};
  Lanes<2> lanes(world, layouts[0]);
  lanes.seed(particles);
  for (std::size_t round = 1; round < layouts.size(); ++round) {
    for (int n = 0; n < 3; ++n) lanes.step();
    bool sides_agree = false;
    const Springs before = lanes.springs(sides_agree);
    const std::uint64_t digest = lanes.digest();

    ASSERT_NO_THROW(lanes.rebuild(layouts[round])) << "round " << round;

    EXPECT_EQ(lanes.springs(sides_agree), before) << "round " << round;
    EXPECT_EQ(lanes.digest(), digest);
  }
}

template <int Dim>
void expect_same_sums(bool is_periodic) {
  const Domain domain = long_box<Dim>(is_periodic);
  const auto particles = random_particles(Dim, domain, Dim == 2 ? 120 : 300, 0.5, 6);
  World<Dim> world = world_of<Dim>(domain, kCutoff, kSkin, 200);
  Lanes<Dim> one(world, {0, 12});
  one.seed(particles);
  for (int n = 0; n < 4; ++n) one.step();
  for (const auto& cuts :
       {std::vector<int>{0, 2, 12}, {0, 10, 12}, {0, 2, 4, 6, 8, 10, 12}, {0, 3, 5, 12}}) {
    Lanes<Dim> many(world, cuts);
    many.seed(particles);

    for (int n = 0; n < 4; ++n) many.step();

    EXPECT_EQ(many.digest(), one.digest()) << cuts.size() - 1 << " lanes, " << Dim << "D";
  }
}

TEST(Lane, AnyCutsGiveTheSameBits) {
  for (const bool is_periodic : {false, true}) {
    expect_same_sums<2>(is_periodic);
    expect_same_sums<3>(is_periodic);
  }
}

TEST(Lane, AnyChunksGiveTheSameBits) {
  const Domain domain = long_box<2>(true);
  const auto particles = random_particles(2, domain, 150, 0.5, 7);
  World<2> world = world_of<2>(domain, kCutoff, kSkin, 200);
  std::vector<std::uint64_t> digests;
  for (const std::int64_t pairs : {1, 300, 1 << 20}) {
    Lanes<2> lanes(world, {0, 6, 12});
    lanes.seed(particles);
    for (std::size_t l = 0; l < 2; ++l) lanes[l].lists.cut_chunks(pairs);

    for (int n = 0; n < 3; ++n) lanes.step();

    digests.push_back(lanes.digest());
  }
  EXPECT_EQ(digests, std::vector<std::uint64_t>(3, digests[0]));
}

/// Sum of the forces on all rows that were advanced, component by component.
std::array<ExactSum, 3> total_force;
RowKernel real_rows = nullptr;

template <int Dim>
RowSpeeds sum_and_advance(const RowJob& job) {
  for (std::int32_t i = job.begin; i < job.end; ++i) {
    for (int c = 0; c < Dim; ++c)
      total_force[static_cast<std::size_t>(c)].add(job.force[i * Layout<Dim>::kForce + c] -
                                                   job.rounder);
  }
  return real_rows(job);
}

template <int Dim>
void expect_no_net_force() {
  Domain domain = long_box<Dim>(true);
  domain.periodic = {true, true, Dim == 3};
  auto particles = random_particles(Dim, domain, Dim == 2 ? 150 : 300, 0.5, 16);
  World<Dim> world = world_of<Dim>(domain, kCutoff, kSkin, 200);
  real_rows = std::exchange(world.kernels.rows, &sum_and_advance<Dim>);
  Lanes<Dim> lanes(world, {0, 4, 7, 12});
  lanes.seed(particles);
  for (int n = 0; n < 12; ++n) {
    total_force = {};
    if (n % 5 == 4)
      lanes.rebuild(n % 2 == 0 ? std::vector<int>{0, 5, 8, 12} : std::vector<int>{0, 3, 6, 12});

    lanes.step();

    for (const ExactSum& sum : total_force) EXPECT_EQ(sum.value(), 0.0) << Dim << "D, step " << n;
  }
}

TEST(Lane, InternalForcesOfAPeriodicBoxSumToExactlyZeroInEveryStep) {
  expect_no_net_force<2>();
  expect_no_net_force<3>();
}

template <int Dim>
void expect_same_bits_with_any_lists() {
  const Domain domain = long_box<Dim>(true);
  auto particles = random_particles(Dim, domain, Dim == 2 ? 120 : 250, 0.5, 26);
  std::vector<std::uint64_t> digests;
  for (const int way : {0, 1, 2, 3}) {
    World<Dim> world = world_of<Dim>(domain, kCutoff, way == 1 ? 0.5 * kSkin : kSkin, 200);
    if (way == 3) std::reverse(particles.begin(), particles.end());
    const int end = world.grid.num_slabs();
    Lanes<Dim> lanes(world, {0, 4, end});
    lanes.seed(particles);
    for (int n = 0; n < 40; ++n) {
      if (way == 2 || n == 17 * way) lanes.rebuild({0, 3 + n % 4, end});
      lanes.step();
    }
    digests.push_back(lanes.digest());
  }
  EXPECT_EQ(digests, std::vector<std::uint64_t>(4, digests[0])) << Dim << "D";
}

TEST(Lane, SkinScheduleAndOrderAreInNoBit) {
  expect_same_bits_with_any_lists<2>();
  expect_same_bits_with_any_lists<3>();
}

TEST(Lane, NamesTheLowerIdOfTheWorstOverlapFirstOnAnyCuts) {
  const Domain domain = long_box<2>(false);
  World<2> world = world_of<2>(domain, kCutoff, kSkin, 200);
  std::vector<ParticleData> pair = random_particles(2, domain, 2, 0.5, 5);
  for (const double way : {-1.0, 1.0}) {  // the lower id on either side, and so in either row
    for (const int begin : {0, 4}) {
      for (ParticleData& p : pair) p.position = Vec3(7.0, 1.0, 0.0);
      pair[0].position.x() += 0.3 * way;
      std::vector<int> cuts{0, 6, 12};
      if (begin == 0) cuts = {0, 12};
      Lanes<2> lanes(world, cuts);
      lanes.seed(pair);
      WorstOverlap worst;
      for (std::size_t l = 0; l + 1 < cuts.size(); ++l) {
        const WorstOverlap here = worst_overlap(lanes[l].brick);
        if (here.is_worse_than(worst)) worst = here;
      }
      EXPECT_EQ(worst.id, std::min(pair[0].id, pair[1].id));
      EXPECT_EQ(worst.with, std::max(pair[0].id, pair[1].id));
      const ParticleData& first = pair[0].id == worst.id ? pair[0] : pair[1];
      EXPECT_EQ(worst.position[0], first.position.x());
    }
  }
}

TEST(Lane, BondsMoveWithTheirParticlesAndKeepTheirState) {
  const Domain domain = long_box<2>(false);
  std::vector<ParticleData> chain;
  std::vector<BondData> bonds;
  for (int p = 0; p < 13; ++p) {
    chain.push_back({p + 1, 0, 0.5, 1000.0, Vec3(0.6 + p, 1.5 + 0.1 * (p % 2), 0.0),
                     Vec3(0.0, p % 3, 0.0), Vec3(0, 0, p % 4), false});
    if (p > 0) bonds.push_back({p, p + 1, 0});
  }
  World<2> world = world_of<2>(domain, kCutoff, kSkin, 13, true);
  world.bond_laws = {BondLaw{"b", 1e5}};
  Lanes<2> lanes(world, {0, 3, 6, 12});
  lanes.seed(chain, bonds);
  for (int n = 0; n < 5; ++n) lanes.step();
  const auto states = [&lanes] {
    std::map<std::int64_t, std::array<double, 2>> all;
    for (std::size_t l = 0; l < lanes.size(); ++l) {
      for (const auto& bond : lanes[l].brick.bonds.bonds()) {
        const auto [it, is_new] = all.try_emplace(bond.id_a, bond.state);
        EXPECT_EQ(it->second, bond.state)
            << "bond of particle " << bond.id_a << " differs across a cut";
      }
    }
    return all;
  };
  const auto before = states();

  lanes.rebuild({0, 5, 8, 12});
  const auto after = states();

  ASSERT_EQ(before.size(), 12U);
  EXPECT_NE(before.at(3)[0], 0.0);
  EXPECT_EQ(after, before);
}

TEST(Lane, RefusesABondLongerThanACellOnAnyNumberOfLanes) {
  const Domain domain = long_box<2>(false);
  const double width = 14.0 / 12.0;
  for (const auto& cuts : {std::vector<int>{0, 12}, {0, 5, 12}, {0, 6, 12}, {0, 4, 12}}) {
    std::vector<ParticleData> pair(2);
    for (int p = 0; p < 2; ++p) {
      pair[static_cast<std::size_t>(p)] = {
          p + 1,        0,    0.5, 1000.0, Vec3((4.5 + p) * width, 1.5, 0.0), Vec3::Zero(),
          Vec3::Zero(), false};
    }
    World<2> world = world_of<2>(domain, kCutoff, kSkin, 2, true);
    world.bond_laws = {BondLaw{"b", 1e5}};
    Lanes<2> lanes(world, cuts);
    lanes.seed(pair, std::vector<BondData>{{1, 2, 0}});
    for (std::size_t l = 0; l < lanes.size(); ++l) {
      auto& store = lanes[l].brick.store;
      for (std::int32_t i = 0; i < store.num_owned; ++i) {
        if (store.id[static_cast<std::size_t>(i)] == 2) store.x(i)[0] += width;
      }
    }

    EXPECT_THROW(lanes.rebuild(cuts), RunError) << "second lane from slab " << cuts[1];
  }
}

TEST(Lane, TellsAfterARebuildThatAStepWasComputedBeyondHalfTheSkin) {
  const Domain domain = long_box<2>(false);
  auto particles = random_particles(2, domain, 20, 0.5, 9);
  for (ParticleData& p : particles) p.velocity = Vec3(0.0, 1.0, 0.0);
  World<2> world = world_of<2>(domain, kCutoff, kSkin, 20);
  const double last_step = world.dt * 1.0;  // of that nothing was computed with the old lists
  Lanes<2> lanes(world, {0, 12});
  lanes.seed(particles);
  lanes[0].brick.store.x(3)[1] += 0.4999 * kSkin + last_step;
  lanes.rebuild({0, 12});
  EXPECT_EQ(barchan::travel(lanes[0].brick).distance2, 0.0);
  lanes[0].brick.store.x(3)[1] += 0.5001 * kSkin + last_step;

  lanes.rebuild({0, 12});

  EXPECT_NEAR(std::sqrt(barchan::travel(lanes[0].brick).distance2), 0.5001 * kSkin, 1e-12);
}

TEST(Lane, ExternalForcesMoveWithTheirParticles) {
  const Domain domain = long_box<2>(false);
  const auto particles = random_particles(2, domain, 60, 0.5, 8);
  World<2> world = world_of<2>(domain, kCutoff, kSkin, 60);
  Lanes<2> lanes(world, {0, 6, 12});
  lanes.seed(particles);
  auto& store = lanes[0].brick.store;  // the other lane has none yet
  store.external.assign(static_cast<std::size_t>(store.num_owned) * Layout<2>::kForce, 0.0);
  for (std::int32_t i = 0; i < store.num_owned; ++i) {
    store.external[static_cast<std::size_t>(i) * Layout<2>::kForce] =
        static_cast<double>(store.id[static_cast<std::size_t>(i)]);
  }
  const auto given =
      std::vector<std::int64_t>(store.id.begin(), store.id.begin() + store.num_owned);

  lanes.rebuild({0, 3, 12});

  std::size_t found = 0;
  for (std::size_t l = 0; l < 2; ++l) {
    const auto& s = lanes[l].brick.store;
    for (std::int32_t i = 0; i < s.num_owned; ++i) {
      const auto id = s.id[static_cast<std::size_t>(i)];
      const bool is_given = std::ranges::find(given, id) != given.end();
      const double f =
          s.external.empty() ? 0.0 : s.external[static_cast<std::size_t>(i) * Layout<2>::kForce];
      EXPECT_EQ(f, is_given ? static_cast<double>(id) : 0.0);
      found += is_given ? 1 : 0;
    }
  }
  EXPECT_EQ(found, given.size());
}

}  // namespace
}  // namespace barchan::test
