#include <barchan/tasks/strip_plan.hpp>

#include <gtest/gtest.h>

#include <numeric>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

struct Case {
  Model model;
  ParticleSet set;

  Case() {
    model.domain.hi = Vec3(8, 2, 0);
    model.search.skin = 0.1;
    for (int i = 0; i < 160; ++i) {
      ParticleData p;
      p.id = i + 1;
      p.radius = 0.2;
      p.position = Vec3(0.025 + 0.05 * i, 1.0, 0.0);
      set.particles.push_back(p);
    }
  }
};

TEST(StripPlan, CutsSlabsNoNarrowerThanTheReach) {
  const Case c;

  const StripPlan plan = plan_strips(c.model, c.set);

  EXPECT_GE(plan.slab_width, search_reach(c.model, c.set, 0.1));
  EXPECT_EQ(plan.slab_counts.size(), 16U);
  EXPECT_EQ(plan.most_ranks(), 8);
}

TEST(StripPlan, GivesEveryParticleToOneStrip) {
  const Case c;
  const StripPlan plan = plan_strips(c.model, c.set);

  for (int ranks = 1; ranks <= plan.most_ranks(); ++ranks) {
    const auto counts = plan.strip_counts(ranks);
    EXPECT_EQ(counts.size(), static_cast<std::size_t>(ranks));
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}), 160);
  }
}

TEST(StripPlan, SaysHowManyRanksFit) {
  const Case c;

  EXPECT_THROW((void)plan_strips(c.model, c.set).strip_counts(9), InputError);
}

TEST(SearchReach, LeavesRoomForALongBondToStretch) {
  Case c;
  c.set.bonds.push_back({1, 2, 0});

  EXPECT_NEAR(search_reach(c.model, c.set, 0.1), 1.1 * 0.4 + 0.1, 1e-12);

  c.set.bonds.push_back({1, 21, 0});  // a metre apart
  EXPECT_NEAR(search_reach(c.model, c.set, 0.1), 1.1 * 1.0 + 0.1, 1e-12);
  c.set.bonds.back().length = 1.5;
  EXPECT_NEAR(search_reach(c.model, c.set, 0.1), 1.1 * 1.5 + 0.1, 1e-12);
}

}  // namespace
}  // namespace barchan
