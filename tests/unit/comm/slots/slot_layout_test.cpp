#include <barchan/comm/slots/slot_layout.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace barchan {
namespace {

std::vector<MessageKey> every_slot() {
  std::vector<MessageKey> keys;
  for (const Channel channel : {Channel::Halo, Channel::Bulk}) {
    for (const Side side : {Side::Left, Side::Right}) {
      for (const std::uint64_t number : {1U, 2U}) keys.push_back({channel, side, number});
    }
  }
  return keys;
}

TEST(SlotLayout, KeepsWordsAndSlotsApartAndOnCacheLines) {
  for (const std::size_t halo : {0U, 1U, 64U, 1000U}) {
    const SlotLayout layout{{halo, 777}};
    std::vector<std::pair<std::size_t, std::size_t>> ranges;  // begin, end
    for (const MessageKey& key : every_slot()) {
      ranges.emplace_back(layout.word(key), layout.word(key) + SlotLayout::kWordBytes);
      ranges.emplace_back(layout.slot(key),
                          layout.slot(key) + slot_bytes(layout.capacity.of(key.channel)));
    }
    std::ranges::sort(ranges);

    for (std::size_t i = 0; i < ranges.size(); ++i) {
      EXPECT_EQ(ranges[i].first % 64, 0U);
      const std::size_t next = i + 1 < ranges.size() ? ranges[i + 1].first : layout.total();
      EXPECT_EQ(ranges[i].second, next);
    }
  }
}

TEST(SlotLayout, TakesTurnsBetweenTwoSlots) {
  const SlotLayout layout{{100, 100}};

  EXPECT_NE(layout.slot({Channel::Halo, Side::Left, 5}),
            layout.slot({Channel::Halo, Side::Left, 6}));
  EXPECT_EQ(layout.slot({Channel::Halo, Side::Left, 5}),
            layout.slot({Channel::Halo, Side::Left, 7}));
}

TEST(SlotLayout, HasRoomForHeaderPayloadAndTrailer) {
  EXPECT_GE(slot_bytes(1), kHeaderBytes + 1 + 7 + 8);
  EXPECT_GE(slot_bytes(64), kHeaderBytes + 64 + 8);
}

TEST(SlotLayout, WhatGoesRightArrivesLeft) {
  EXPECT_EQ(SlotLayout::at_receiver({Channel::Bulk, Side::Right, 3}).side, Side::Left);
  EXPECT_EQ(SlotLayout::at_receiver({Channel::Bulk, Side::Right, 3}).channel, Channel::Bulk);
}

}  // namespace
}  // namespace barchan
