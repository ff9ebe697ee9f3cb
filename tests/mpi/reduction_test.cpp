#include <barchan/comm/base/reduction.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace barchan {
namespace {

constexpr int direct = Reduction::kDefaultDirectRanks;
constexpr int tree = 0;

double maximum_of(int rank, int round) {
  return std::sin(static_cast<double>(7 * rank + 13 * round));
}
std::int64_t term_of(int rank, int round) {
  return static_cast<std::int64_t>(rank + 1) << (round % 40);
}

class ReductionEitherWay : public testing::TestWithParam<int> {
 protected:
  void begin(Reduction& reduction, int round) {
    const std::array maxima{maximum_of(comm_.rank(), round), -maximum_of(comm_.rank(), round)};
    const std::array sums{term_of(comm_.rank(), round), -term_of(comm_.rank(), round + 1),
                          std::int64_t{1}};
    reduction.begin(maxima, sums);
  }

  void expect(const Reduction& reduction, int round) {
    std::array maxima{-2.0, -2.0};
    std::array<std::int64_t, 3> sums{};
    for (int rank = 0; rank < comm_.size(); ++rank) {
      maxima[0] = std::max(maxima[0], maximum_of(rank, round));
      maxima[1] = std::max(maxima[1], -maximum_of(rank, round));
      sums[0] += term_of(rank, round);
      sums[1] -= term_of(rank, round + 1);
      sums[2] += 1;
    }
    for (std::size_t i = 0; i < maxima.size(); ++i)
      EXPECT_EQ(reduction.maxima()[i], maxima[i]) << "round " << round;
    for (std::size_t i = 0; i < sums.size(); ++i)
      EXPECT_EQ(reduction.sums()[i], sums[i]) << "round " << round;
  }

  Communicator comm_ = Communicator::world();
};

TEST_P(ReductionEitherWay, GivesExactMaximaAndSumsOnEveryRank) {
  Reduction reduction(comm_, 2, 3, GetParam());

  for (int round = 0; round < 300; ++round) {
    begin(reduction, round);
    reduction.wait();
    expect(reduction, round);
  }
}

TEST_P(ReductionEitherWay, LetsTwoBeInFlightAndEndInAnyOrder) {
  Reduction first(comm_, 2, 3, GetParam());
  Reduction second(comm_, 2, 3, GetParam());
  std::mt19937 random(static_cast<unsigned>(comm_.rank()));

  for (int round = 0; round < 100; ++round) {
    begin(first, round);
    if (random() % 4 == 0) std::this_thread::sleep_for(std::chrono::microseconds(random() % 300));
    begin(second, 1000 + round);
    const bool is_first_first = random() % 2 == 0;
    (is_first_first ? first : second).wait();
    (is_first_first ? second : first).wait();
    expect(first, round);
    expect(second, 1000 + round);
  }
}

TEST_P(ReductionEitherWay, CarriesNaNAndForgetsTheSignOfZero) {
  Reduction reduction(comm_, 2, 0, GetParam());
  const bool is_last = comm_.rank() == comm_.size() - 1;
  const std::array maxima{is_last ? std::numeric_limits<double>::quiet_NaN() : 1e300, -0.0};

  reduction.begin(maxima, {});
  reduction.wait();

  EXPECT_TRUE(std::isnan(reduction.maxima()[0]));
  EXPECT_FALSE(std::signbit(reduction.maxima()[1]));
}

TEST_P(ReductionEitherWay, RefusesTwoBeginsInARowAndOtherSizes) {
  Reduction reduction(comm_, 1, 1, GetParam());
  const std::array maximum{1.0};
  const std::array<std::int64_t, 1> sum{1};

  EXPECT_THROW(reduction.begin({}, sum), std::logic_error);
  reduction.begin(maximum, sum);
  EXPECT_TRUE(reduction.is_in_flight());
  EXPECT_THROW(reduction.begin(maximum, sum), std::logic_error);
  reduction.wait();
  EXPECT_TRUE(reduction.test());
}

TEST_P(ReductionEitherWay, NamesTheRankThatIsMissing) {
  Reduction reduction(comm_, 2, 3, GetParam());
  const int late = comm_.size() - 1;
  std::string said;
  if (comm_.rank() != late) {
    begin(reduction, 1);
    try {
      reduction.wait(0.2);
    } catch (const WaitError& error) {
      said = error.what();
    }
  }
  comm_.barrier();
  if (comm_.rank() == late) begin(reduction, 1);
  reduction.wait();

  expect(reduction, 1);
  if (comm_.rank() == late) return;
  EXPECT_NE(said.find("reduction 1 of all ranks"), std::string::npos) << said;
  const bool is_named = said.find("rank " + std::to_string(late)) != std::string::npos;
  EXPECT_EQ(is_named, GetParam() == direct) << said;
}

TEST_P(ReductionEitherWay, MayBeDroppedInFlight) {
  Reduction reduction(comm_, 2, 3, GetParam());

  begin(reduction, 1);

  SUCCEED();
}

INSTANTIATE_TEST_SUITE_P(Comm, ReductionEitherWay, testing::Values(direct, tree),
                         [](const auto& instance) {
                           return instance.param == tree ? "tree" : "direct";
                         });

}  // namespace
}  // namespace barchan
