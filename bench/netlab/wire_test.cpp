#include "wire.hpp"

#include <gtest/gtest.h>

namespace netlab {
namespace {

constexpr double gigabit = 8.0;  // ns per byte

TEST(Wire, DelaysAPacketByItsWireTimeAndTheDelay) {
  Wire wire(2, {.delay = 200'000, .ns_per_byte = gigabit});

  EXPECT_EQ(wire.leave(0, 1, 1, 1000, 5'000), 5'000 + 8'000 + 200'000);
}

TEST(Wire, SendsOnePacketAfterTheOther) {
  Wire wire(2, {.delay = 200'000, .ns_per_byte = gigabit});

  wire.leave(0, 1, 1, 1000, 0);

  EXPECT_EQ(wire.leave(0, 1, 1, 1000, 0), 2 * 8'000 + 200'000);
  EXPECT_EQ(wire.leave(1, 0, 2, 1000, 0), 8'000 + 200'000)
      << "the other direction has its own port";
}

TEST(Wire, AddsNothingAtTheReceiverForOneSender) {
  Wire wire(2, {.ns_per_byte = gigabit});

  for (int n = 0; n < 10; ++n) {
    const auto due = wire.leave(0, 1, 1, 1500, 0);
    EXPECT_EQ(wire.arrive(1, 1500, *due), due);
  }
}

TEST(Wire, QueuesSeveralSendersAtTheReceiver) {
  Wire wire(3, {.ns_per_byte = gigabit});

  const auto first = wire.leave(0, 2, 1, 1000, 0);
  const auto second = wire.leave(1, 2, 2, 1000, 0);

  EXPECT_EQ(wire.arrive(2, 1000, *first), 8'000);
  EXPECT_EQ(wire.arrive(2, 1000, *second), 16'000);
}

TEST(Wire, DropsWhatAFullPortCannotHold) {
  Wire wire(2, {.ns_per_byte = gigabit, .queue_bytes = 2500});

  int held = 0;
  for (int n = 0; n < 10; ++n) held += wire.leave(0, 1, 1, 1000, 0).has_value();

  EXPECT_EQ(held, 3) << "the third is let in at 2000 bytes of backlog, the fourth not at 3000";
}

TEST(Wire, KeepsTheOrderOfAFlowUnderJitterUnlessToldOtherwise) {
  const WireOptions ordered{.delay = 1'000, .jitter = 900};
  WireOptions unordered = ordered;
  unordered.keep_order = false;

  const auto count_overtakings = [](Wire wire) {
    int count = 0;
    Nanoseconds last = 0;
    for (int n = 0; n < 1000; ++n) {
      const Nanoseconds due = *wire.leave(0, 1, 1, 100, n);
      count += due < last;
      last = due;
    }
    return count;
  };

  EXPECT_EQ(count_overtakings(Wire(2, ordered)), 0);
  EXPECT_GT(count_overtakings(Wire(2, unordered)), 100);
}

TEST(Wire, DrawsJitterWithinItsWidthAndTheSameForTheSameSeed) {
  const WireOptions options{.delay = 1'000'000, .jitter = 500'000, .keep_order = false, .seed = 7};
  Wire wire(2, options);
  Wire again(2, options);

  double sum = 0;
  for (int n = 0; n < 10'000; ++n) {
    const Nanoseconds due = *wire.leave(0, 1, 1, 100, 0);
    EXPECT_GE(due, 500'000);
    EXPECT_LE(due, 1'500'000);
    again.leave(1, 0, 1, 100, 0);  // another link does not disturb
    EXPECT_EQ(again.leave(0, 1, 1, 100, 0), due);
    sum += double(due);
  }
  EXPECT_NEAR(sum / 10'000, 1e6, 1e4);
}

TEST(Wire, MultipliesTheDelayOfTheGivenShareOfPackets) {
  Wire wire(2, {.delay = 1'000, .spike_share = 0.01, .spike_factor = 10, .keep_order = false});

  int spikes = 0;
  for (int n = 0; n < 100'000; ++n) spikes += wire.leave(0, 1, 1, 100, 0) == 10'000;

  EXPECT_NEAR(spikes, 1000, 150);
}

}  // namespace
}  // namespace netlab
