#include <barchan/comm/slots/slot_layout.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace barchan {
namespace {

constexpr int kLinks = 3;

std::vector<MessageKey> every_slot(const SlotCapacity& capacity) {
  std::vector<MessageKey> keys;
  for (const Channel channel : {Channel::Halo, Channel::Bulk}) {
    for (int link = 0; link < kLinks; ++link) {
      for (int n = 1; n <= capacity.slots(channel); ++n)
        keys.push_back({channel, link, static_cast<std::uint64_t>(n)});
    }
  }
  return keys;
}

TEST(SlotLayout, KeepsWordsAndSlotsApartAndOnCacheLines) {
  for (const std::size_t halo : {0U, 1U, 64U, 1000U}) {
    const int depth = static_cast<int>(halo % 7);
    const SlotLayout layout{{halo, 777, depth}, kLinks};
    std::vector<std::pair<std::size_t, std::size_t>> ranges;  // begin, end
    for (const MessageKey& key : every_slot(layout.capacity)) {
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
  const SlotLayout layout{{100, 100}, kLinks};

  EXPECT_NE(layout.slot({Channel::Halo, 1, 5}), layout.slot({Channel::Halo, 1, 6}));
  EXPECT_EQ(layout.slot({Channel::Halo, 1, 5}), layout.slot({Channel::Halo, 1, 7}));
}

TEST(SlotLayout, UsesAHaloSlotAgainAfterTwiceTheDepthAndTwo) {
  const SlotLayout layout{{100, 100, 3}, kLinks};

  for (std::uint64_t n = 6; n < 13; ++n)
    EXPECT_NE(layout.slot({Channel::Halo, 1, 5}), layout.slot({Channel::Halo, 1, n}));
  EXPECT_EQ(layout.slot({Channel::Halo, 1, 5}), layout.slot({Channel::Halo, 1, 13}));
  EXPECT_EQ(layout.slot({Channel::Bulk, 1, 5}), layout.slot({Channel::Bulk, 1, 7}));
}

TEST(SlotLayout, HasRoomForHeaderPayloadAndTrailer) {
  EXPECT_GE(slot_bytes(1), kHeaderBytes + 1 + 7 + 8);
  EXPECT_GE(slot_bytes(64), kHeaderBytes + 64 + 8);
}

TEST(SlotLayout, PutsALinkWhereItIsWhateverTheNumberOfLinks) {
  const SlotLayout few{{100, 200}, 3}, many{{100, 200}, 26};

  EXPECT_EQ(few.slot({Channel::Bulk, 2, 1}), many.slot({Channel::Bulk, 2, 1}));
  EXPECT_EQ(few.word({Channel::Bulk, 2, 1}), many.word({Channel::Bulk, 2, 1}));
}

}  // namespace
}  // namespace barchan
