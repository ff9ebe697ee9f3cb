#include <barchan/tasks/list_life.hpp>

#include <gtest/gtest.h>

namespace barchan {
namespace {

constexpr double kSkin = 0.02, kDt = 1e-3;

TEST(ListLife, HoldsListsAsLongAsSpeedsMayDouble) {
  for (const double speed : {0.2, 0.7, 1.0, 2.4, 4.0}) {
    ListLife life(kSkin, kDt, 0.0);
    life.hear(speed, 100);
    life.renew(102);

    const auto served = static_cast<double>(life.end() - 1 - 102);  // steps after the first

    EXPECT_LE(2.0 * speed * served * kDt, 0.5 * kSkin) << speed;
    EXPECT_GT(2.0 * speed * (served + 1.0) * kDt, 0.5 * kSkin) << speed;
  }
}

TEST(ListLife, IsAtLeastOneStepHoweverFastParticlesAre) {
  ListLife life(kSkin, kDt, 9.81);
  life.hear(1e6, 7);

  life.renew(9);

  EXPECT_EQ(life.end(), 10);
}

TEST(ListLife, CountsWhatGravityHasAddedSinceTheSpeedWasMeasured) {
  ListLife early(kSkin, kDt, 100.0), late(kSkin, kDt, 100.0);
  early.hear(0.5, 10);
  late.hear(0.5, 2);

  early.renew(12);
  late.renew(12);

  EXPECT_LT(late.end(), early.end());
}

TEST(ListLife, LeavesSlowParticlesToTheChecksAndIsLiftedByTheirAnswers) {
  ListLife life(kSkin, kDt, 0.0);
  life.hear(1e-3, 0);
  life.renew(0);
  const auto never = life.end();
  life.hear(2.0, 4);
  life.renew(6);
  EXPECT_LT(life.end(), 16);

  life.lift();

  EXPECT_EQ(life.end(), never);
  EXPECT_GT(never, std::int64_t{1} << 60);
}

}  // namespace
}  // namespace barchan
