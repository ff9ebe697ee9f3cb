#include <barchan/app/experiments/statistics.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace barchan::app {
namespace {

/// Steps of an experiment on a noisy machine: some scatter, and now and then a run that another
/// program held up.
std::vector<double> noisy(std::mt19937& draw, std::size_t n, double step) {
  std::normal_distribution<double> scatter(0.0, 0.015);
  std::bernoulli_distribution held_up(0.05);
  std::vector<double> steps;
  for (std::size_t k = 0; k < n; ++k)
    steps.push_back(step * std::exp(scatter(draw)) * (held_up(draw) ? 1.2 : 1.0));
  return steps;
}

Interval of_pairs(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<std::pair<double, double>> pairs;
  for (std::size_t k = 0; k < a.size(); ++k) pairs.emplace_back(a[k], b[k]);
  return paired_ratio(pairs, 0.95);
}

TEST(Statistics, BoundsOfFewPairsAreThoseOfTheTables) {
  // The sign test: of six pairs the widest bounds hold with 1 - 2/64, of five with 1 - 2/32.
  const std::vector<double> ones(6, 1.0), b{1.01, 1.02, 1.03, 1.04, 1.05, 1.06};

  const Interval six = of_pairs(ones, b);
  const Interval five = of_pairs({ones.begin(), ones.end() - 1}, {b.begin(), b.end() - 1});

  EXPECT_NEAR(six.confidence, 1.0 - 2.0 / 64.0, 1e-12);
  EXPECT_NEAR(six.low, 1.01, 1e-12);
  EXPECT_NEAR(six.high, 1.06, 1e-12);
  EXPECT_NEAR(five.confidence, 1.0 - 2.0 / 32.0, 1e-12);
}

TEST(Statistics, BoundsOfTwoSetsAreThoseOfTheTables) {
  // Mann and Whitney: of four and four the widest bounds hold with 1 - 2/70. Of five and five, U is
  // at most 2 with probability 4/252.
  const Interval four = unpaired_ratio({1, 1, 1, 1}, {2, 2, 2, 2}, 0.95);
  const Interval five = unpaired_ratio({1, 1, 1, 1, 1}, {2, 2, 2, 2, 2}, 0.965);

  EXPECT_NEAR(four.confidence, 1.0 - 2.0 / 70.0, 1e-12);
  EXPECT_NEAR(four.value, 2.0, 1e-12);
  EXPECT_NEAR(five.confidence, 1.0 - 2.0 * 4.0 / 252.0, 1e-12);
}

TEST(Statistics, OneRunEachHasNoBounds) {
  EXPECT_EQ(unpaired_ratio({1.0}, {2.0}, 0.95).confidence, 0.0);
  EXPECT_EQ(paired_ratio({{1.0, 2.0}}, 0.95).confidence, 0.0);
}

TEST(Statistics, FindsFivePerCentAndNothingWhereThereIsNothing) {
  std::mt19937 draw(20);  // NOLINT(cert-msc51-cpp): the same in every run
  int found = 0, false_alarms = 0;
  constexpr int kTries = 200;
  for (int n = 0; n < kTries; ++n) {
    const auto a = noisy(draw, 12, 100.0);
    found += of_pairs(a, noisy(draw, 12, 105.0)).low > 1.0 ? 1 : 0;
    false_alarms += of_pairs(a, noisy(draw, 12, 100.0)).holds(1.0) ? 0 : 1;
  }

  EXPECT_GE(found, 9 * kTries / 10);
  EXPECT_LE(false_alarms, kTries / 10);
}

TEST(Statistics, SpreadAndMedian) {
  EXPECT_DOUBLE_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_DOUBLE_EQ(spread({90.0, 100.0, 110.0}), 0.2);
  EXPECT_DOUBLE_EQ(spread({90.0}), 0.0);
}

}  // namespace
}  // namespace barchan::app
