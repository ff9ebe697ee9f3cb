#pragma once

#include <barchan/comm/slots/message.hpp>
#include <barchan/comm/slots/slot_exchange.hpp>

namespace barchan {

/// A rank's window, a block for each of its links:
///
///     words, halo and bulk   | 0 | 1 | 0 | 1 |     a cache line each
///     halo slots             | 0 | 1 |             header, payload, trailer
///     bulk slots             | 0 | 1 |
///
/// Links are the owner's: what is sent lands in the block of the receiver's link, so nothing is
/// confused where two links lead to the same rank. Where a block lies depends on its number only,
/// since ranks have different numbers of links. Each slot has its own word, since a neighbour may
/// announce n+1 before this rank has looked for n.
struct SlotLayout {
  static constexpr std::size_t kWordBytes = 64;
  static constexpr std::size_t kBlockWords = 2 * kNumChannels * kWordBytes;

  SlotCapacity capacity;
  int num_links = 0;

  [[nodiscard]] constexpr std::size_t word(const MessageKey& key) const {
    return block(key.link) +
           kWordBytes * static_cast<std::size_t>(2 * static_cast<int>(key.channel) + key.slot());
  }
  [[nodiscard]] constexpr std::size_t slot(const MessageKey& key) const {
    const std::size_t halo = slot_bytes(capacity.halo), bulk = slot_bytes(capacity.bulk);
    const auto place = static_cast<std::size_t>(key.slot());
    return block(key.link) + kBlockWords +
           (key.channel == Channel::Halo ? place * halo : 2 * halo + place * bulk);
  }
  [[nodiscard]] constexpr std::size_t total() const { return block(num_links); }

 private:
  [[nodiscard]] constexpr std::size_t block(int link) const {
    return static_cast<std::size_t>(link) *
           (kBlockWords + 2 * slot_bytes(capacity.halo) + 2 * slot_bytes(capacity.bulk));
  }
};

}  // namespace barchan
