#include <barchan/core/laws/restitution.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <numbers>

namespace barchan {
namespace {

TEST(Restitution, WithoutTheClampIsThatOfHalfAnOscillation) {
  EXPECT_EQ(restitution_at(0.0, false), 1.0);
  EXPECT_NEAR(restitution_at(0.6, false), std::exp(-std::numbers::pi * 0.75), 1e-15);
  EXPECT_EQ(restitution_at(1.0, false), 0.0);
  EXPECT_EQ(restitution_at(3.0, false), 0.0);
}

TEST(Restitution, WithTheClampIsThatOfSchwagerAndPoeschel) {
  // At zeta 0.6 cosine and sine are 0.6 and 0.8, at zeta 1 both terms cancel, and at zeta 5/4
  // sqrt(zeta² − 1) is 3/4 and arcosh is ln 2.
  EXPECT_EQ(restitution_at(0.0, true), 1.0);
  EXPECT_NEAR(restitution_at(0.6, true), std::exp(-1.5 * std::atan2(0.8, 0.6)), 1e-15);
  EXPECT_NEAR(restitution_at(1.0, true), std::exp(-2.0), 1e-15);
  EXPECT_NEAR(restitution_at(1.25, true), std::pow(2.0, -10.0 / 3.0), 1e-15);
}

TEST(Restitution, HasNoStepWhereTheSpringBecomesOverdamped) {
  for (const double off : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    EXPECT_NEAR(restitution_at(1.0 - off, true) / restitution_at(1.0 + off, true), 1.0,
                4.0 * off + 1e-15)
        << off;
  }
}

TEST(Restitution, IsGivenBackByItsDampingRatio) {
  for (const bool no_tension : {true, false}) {
    EXPECT_EQ(damping_ratio_for(1.0, no_tension), 0.0);
    for (double e = 1.0; e > 1e-9; e *= 0.93) {
      EXPECT_NEAR(restitution_at(damping_ratio_for(e, no_tension), no_tension) / e, 1.0, 1e-13)
          << e << " " << no_tension;
    }
    EXPECT_GT(damping_ratio_for(5e-324, no_tension), 0.9);
    EXPECT_LT(damping_ratio_for(1.0 - 1e-16, no_tension), 1e-15);
  }
}

TEST(Restitution, NeedsAStrongerDashpotWithTheClamp) {
  for (const double e : {0.99, 0.5, 0.1, 0.01})
    EXPECT_GT(damping_ratio_for(e, true), damping_ratio_for(e, false)) << e;
}

}  // namespace
}  // namespace barchan
