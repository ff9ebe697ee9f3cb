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

TEST(CutPlan, HasCellsNoNarrowerThanTheReach) {
  const Case c;

  const CutPlan plan = plan_cuts(c.model, c.set);

  EXPECT_GE(plan.cell[0], search_reach(c.model, c.set, 0.1));
  EXPECT_EQ(plan.room.cells[0], 16);
  EXPECT_EQ(plan.room.most_strips(), 8);
}

TEST(CutPlan, GivesEveryParticleToOneRank) {
  const Case c;
  const CutPlan plan = plan_cuts(c.model, c.set);

  for (int ranks = 1; ranks <= plan.room.most_strips(); ++ranks) {
    for (const CutShape& shape : {CutShape{CutForm::Strips, {ranks, 1, 1}, {}},
                                  CutShape{CutForm::Bricks, {ranks, 2, 1}, {}}}) {
      const auto counts = plan.rank_counts(shape);
      EXPECT_EQ(counts.size(), static_cast<std::size_t>(shape.num_ranks()));
      EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}), 160);
    }
  }
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
