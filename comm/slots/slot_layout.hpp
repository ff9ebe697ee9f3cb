#pragma once

#include <barchan/comm/slots/message.hpp>
#include <barchan/comm/slots/slot_exchange.hpp>

namespace barchan {

/// A rank's window, the same on every rank:
///
///                halo              bulk
///                left     right    left     right
///     words    | 0 | 1 |  0 | 1 |  0 | 1 |  0 | 1 |     a cache line each
///     slots    | 0 | 1 |  0 | 1 |  0 | 1 |  0 | 1 |     header, payload, trailer
///
/// "Left" is the owner's left: what a rank sends to its right lands in the left part of its right
/// neighbour, so nothing is confused where both neighbours are the same rank. Each slot has its own
/// word, since a neighbour may announce n+1 before this rank has looked for n.
struct SlotLayout {
  static constexpr std::size_t kWordBytes = 64;
  static constexpr std::size_t kAllWords = 2 * kNumChannelSides * kWordBytes;

  SlotCapacity capacity;

  [[nodiscard]] constexpr std::size_t word(const MessageKey& key) const {
    return kWordBytes * static_cast<std::size_t>(2 * key.channel_side() + key.slot());
  }
  [[nodiscard]] constexpr std::size_t slot(const MessageKey& key) const {
    const std::size_t halo = slot_bytes(capacity.halo);
    const std::size_t bulk = slot_bytes(capacity.bulk);
    const auto position = 2 * index_of(key.side) + static_cast<std::size_t>(key.slot());
    return kAllWords +
           (key.channel == Channel::Halo ? position * halo : 4 * halo + position * bulk);
  }
  [[nodiscard]] constexpr std::size_t total() const {
    return kAllWords + 4 * slot_bytes(capacity.halo) + 4 * slot_bytes(capacity.bulk);
  }

  /// The same message as its receiver sees it.
  [[nodiscard]] static constexpr MessageKey at_receiver(const MessageKey& key) {
    return {key.channel, opposite(key.side), key.number};
  }
};

}  // namespace barchan
