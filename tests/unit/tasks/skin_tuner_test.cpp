#include <barchan/tasks/skin_tuner.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

namespace barchan {
namespace {

constexpr double kWidest = 0.03;

/// Runs a tuner against a cost of a step by skin. @return steps that each skin served
std::map<double, int> served(const std::function<double(double)>& cost, int num_checks) {
  SkinTuner tuner(kWidest);
  std::map<double, int> steps;
  double skin = kWidest, seconds = 0.0;
  for (int check = 0; check < num_checks; ++check) {
    skin = tuner.wish(16 * check, seconds);
    seconds += 16 * cost(skin);
    steps[skin] += 16;
  }
  return steps;
}

double most_served(const std::map<double, int>& steps) {
  double best = 0.0;
  int most = 0;
  for (const auto& [skin, count] : steps) {
    if (count > most) best = skin, most = count;
  }
  return best;
}

TEST(SkinTuner, FindsTheSkinThatIsFastest) {
  for (const double best : {kWidest, 0.8 * kWidest, 0.64 * kWidest, 0.4096 * kWidest}) {
    const auto steps = served(
        [best](double skin) { return 1e-3 * (1.0 + std::pow(std::log(skin / best), 2)); }, 10000);

    EXPECT_NEAR(most_served(steps), best, 1e-9);
    EXPECT_GT(steps.at(most_served(steps)), 16 * 10000 * 3 / 4);
  }
}

TEST(SkinTuner, StaysWhereItIsWhenNothingIsFaster) {
  EXPECT_EQ(most_served(served([](double) { return 1e-3; }, 10000)), kWidest);
}

TEST(SkinTuner, TriesNothingBeforeATrialIsOver) {
  EXPECT_EQ(served([](double) { return 1e-3; }, 24).size(), 1U);
  EXPECT_EQ(served([](double) { return 1e-9; }, 1000).size(), 1U) << "too short to be measured";
}

TEST(SkinTuner, NeverWishesForASkinWiderThanTheFirst) {
  for (const auto& [skin, count] : served([](double skin) { return 1e-4 / skin; }, 10000))
    EXPECT_LE(skin, kWidest);
}

}  // namespace
}  // namespace barchan
