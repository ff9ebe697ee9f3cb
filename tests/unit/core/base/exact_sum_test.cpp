#include <barchan/core/base/exact_sum.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace barchan {
namespace {

double sum_of(const std::vector<double>& terms) {
  ExactSum sum;
  for (const double t : terms) sum.add(t);
  return sum.value();
}

TEST(ExactSum, DoesNotDependOnTheOrderOrOnPartialSums) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-200, 200);
  std::vector<double> terms;
  for (int n = 0; n < 2000; ++n) terms.push_back(std::ldexp(mantissa(random), exponent(random)));
  ExactSum all;
  for (const double t : terms) all.add(t);
  for (int round = 0; round < 20; ++round) {
    std::shuffle(terms.begin(), terms.end(), random);
    ExactSum parts[3], together;

    for (std::size_t n = 0; n < terms.size(); ++n) parts[(n * n) % 3].add(terms[n]);
    for (const ExactSum& part : parts) together.add(part);

    EXPECT_EQ(together.digits(), all.digits());
    EXPECT_EQ(together.value(), all.value());
  }
}

TEST(ExactSum, IsTheSameAfterACarryAndHoldsEndlesslyManyTerms) {
  ExactSum sum, term;
  term.add(-0.1);
  for (std::int64_t& digit : sum.digits()) digit = -(std::int64_t{1} << 62);
  sum.digits().back() = 0;
  const double before = sum.value();

  sum.carry();

  EXPECT_EQ(sum.value(), before);
  for (std::size_t d = 0; d + 2 < ExactSum::kDigits; ++d) {
    EXPECT_GE(sum.digits()[d], 0);
    EXPECT_LT(sum.digits()[d], std::int64_t{1} << 32);
  }
  for (int n = 0; n < 100; ++n) {
    term.add(term);  // twice as many each time
    term.carry();
  }
  EXPECT_EQ(term.value(), std::ldexp(-0.1, 100));
}

TEST(ExactSum, LosesNothingToCancellation) {
  EXPECT_EQ(sum_of({1e80, 1.0, -1e80}), 1.0);
  EXPECT_EQ(sum_of({1.0, 0x1p-230, -1.0}), 0x1p-230);
  EXPECT_EQ(sum_of({0.1, 0.2, -0.3}),
            static_cast<double>(__float128(0.1) + __float128(0.2) - __float128(0.3)));
  EXPECT_EQ(sum_of({5e-324, 1.0}), 1.0);
  EXPECT_EQ(sum_of({5e-324, -1.0, 1.0}), 5e-324);
  EXPECT_EQ(sum_of({0x1.8p-500, 0x1p-552, -0x1p-500}), 0x1p-501 + 0x1p-552);
  EXPECT_EQ(sum_of({}), 0.0);
  EXPECT_EQ(sum_of({-0.0, 0.0}), 0.0);
}

TEST(ExactSum, AgreesWithQuadruplePrecision) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int round = 0; round < 50; ++round) {
    ExactSum sum;
    __float128 quadruple = 0;
    for (int n = 0; n < 1000; ++n) {
      const double t = std::ldexp(any(random), static_cast<int>(random() % 40));
      sum.add(t);
      quadruple += t;
    }
    const auto expected = static_cast<double>(quadruple);
    EXPECT_NEAR(sum.value(), expected,
                std::fabs(expected) * std::numeric_limits<double>::epsilon());
  }
}

TEST(ExactSum, AddsIntegersExactly) {
  ExactSum sum;
  for (int n = 1; n <= 100000; ++n) sum.add(n % 2 == 0 ? 0x1p52 + n : -0x1p52 - n);
  EXPECT_EQ(sum.value(), 50000.0);
}

TEST(ExactSum, OfManyNegativeTermsIsNegative) {
  ExactSum sum;
  for (int n = 0; n < 1 << 20; ++n) sum.add(-0.5);
  EXPECT_EQ(sum.value(), -0x1p19);
}

TEST(ExactSum, IsNotANumberWhenATermIsNot) {
  EXPECT_TRUE(std::isnan(sum_of({1.0, std::numeric_limits<double>::quiet_NaN()})));
  EXPECT_TRUE(std::isnan(sum_of({std::numeric_limits<double>::infinity(), 1.0})));
}

TEST(ExactSum, HoldsTheLargestNumbers) {
  constexpr double kMost = std::numeric_limits<double>::max();
  EXPECT_EQ(sum_of({kMost, kMost, -kMost}), kMost);
  EXPECT_EQ(sum_of({-kMost}), -kMost);
  EXPECT_EQ(sum_of({-kMost, 1.0, kMost}), 1.0);
  EXPECT_EQ(sum_of({kMost, kMost}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(sum_of({-kMost, -kMost}), -std::numeric_limits<double>::infinity());
  for (int e = 200; e < 1023; ++e) {
    const double large = std::ldexp(1.0, e);
    EXPECT_EQ(sum_of({-large, 0.75 * large}), -0.25 * large) << e;
  }
}

}  // namespace
}  // namespace barchan
