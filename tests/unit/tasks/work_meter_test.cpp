#include <barchan/tasks/work_meter.hpp>

#include <gtest/gtest.h>

#include <vector>

#include <barchan/comm/topology/strips.hpp>

namespace barchan {
namespace {

TEST(WorkMeter, WeighsAllAlikeBeforeItKnowsAnything) {
  const WorkMeter meter(2);

  EXPECT_EQ(meter.weight(0), meter.weight(1));
}

TEST(WorkMeter, TakesTheShortestTimeOfAWindow) {
  WorkMeter meter(2);
  meter.note(0, 1'000'000, 100, 100);   // 100 ns a particle and step
  meter.note(1, 9'000'000, 100, 100);   // 900: the worker was interrupted
  meter.note(0, 2'000'000, 100, 200);   // 100
  meter.note(1, 10'000'000, 100, 200);  // 100
  meter.note(0, 9'000'000, 100, 300);   // 700: now the other
  meter.note(1, 12'000'000, 100, 300);  // 200
  meter.end_window();

  EXPECT_EQ(meter.weight(0), meter.weight(1));
  EXPECT_EQ(meter.weight(0), 6400);
}

TEST(WorkMeter, SmoothsWindowsAndForgetsThem) {
  WorkMeter meter(1);
  std::int64_t ns = 0, step = 0;
  const auto window = [&](std::int64_t each) {
    ns += each * 10 * 50, step += 50;
    meter.note(0, ns, 10, step);
    meter.end_window();
    return meter.weight(0) / 64;
  };

  EXPECT_EQ(window(100), 100);
  EXPECT_EQ(window(200), 150);
  for (int k = 0; k < 20; ++k) window(200);
  EXPECT_EQ(window(200), 200);
}

TEST(WorkMeter, KeepsWhatItKnowsWhileALaneIsEmpty) {
  WorkMeter meter(1);
  meter.note(0, 50'000, 10, 100);
  meter.end_window();
  const std::int64_t before = meter.weight(0);

  meter.note(0, 60'000, 0, 200);
  meter.end_window();

  EXPECT_EQ(meter.weight(0), before);
}

/// Particles to the right of slab 120 cost four times as much, as where sizes are mixed.
TEST(WorkMeter, BalancesWorkInAFewRecuts) {
  constexpr int kLanes = 6, kSlabs = 200, kEach = 50, kSteps = 100;
  const auto cost = [](int slab) { return slab < 120 ? 20 : 80; };
  std::vector<int> cuts = cut_equal(std::vector<std::int64_t>(kSlabs, kEach), kLanes, 2);
  WorkMeter meter(kLanes);
  std::vector<std::int64_t> ns(kLanes, 0), work(kSlabs);
  for (int slab = 0; slab < kSlabs; ++slab)
    work[static_cast<std::size_t>(slab)] = kEach * cost(slab);
  ASSERT_GT(imbalance(cuts, work), 1.5);
  for (int look = 1; look <= 8; ++look) {
    std::vector<std::int64_t> loads(kSlabs);
    for (int l = 0; l < kLanes; ++l) {
      const auto lane = static_cast<std::size_t>(l);
      for (int slab = cuts[lane]; slab < cuts[lane + 1]; ++slab)
        ns[lane] += kSteps * work[static_cast<std::size_t>(slab)];
      meter.note(l, ns[lane], kEach * (cuts[lane + 1] - cuts[lane]), look * kSteps);
    }
    meter.end_window();
    for (int slab = 0; slab < kSlabs; ++slab)
      loads[static_cast<std::size_t>(slab)] = kEach * meter.weight(strip_of(cuts, slab));
    cuts = recut(cuts, loads, kLanes, 2);
  }

  EXPECT_LT(imbalance(cuts, work), 1.06);  // a slab is 5 % of the mean
}

}  // namespace
}  // namespace barchan
