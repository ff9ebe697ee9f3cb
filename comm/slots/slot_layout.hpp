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
  static constexpr std::size_t word_bytes = 64;
  static constexpr std::size_t all_words = 2 * num_lane_sides * word_bytes;

  SlotCapacity capacity;

  [[nodiscard]] constexpr std::size_t word(const MessageKey& key) const {
    return word_bytes * static_cast<std::size_t>(2 * key.lane_side() + key.slot());
  }
  [[nodiscard]] constexpr std::size_t slot(const MessageKey& key) const {
    const std::size_t halo = slot_bytes(capacity.halo);
    const std::size_t bulk = slot_bytes(capacity.bulk);
    const auto position = static_cast<std::size_t>(2 * static_cast<int>(key.side) + key.slot());
    return all_words + (key.lane == Lane::Halo ? position * halo : 4 * halo + position * bulk);
  }
  [[nodiscard]] constexpr std::size_t total() const {
    return all_words + 4 * slot_bytes(capacity.halo) + 4 * slot_bytes(capacity.bulk);
  }

  /// The same message as its receiver sees it.
  [[nodiscard]] static constexpr MessageKey at_receiver(const MessageKey& key) {
    return {key.lane, opposite(key.side), key.number};
  }
};

}  // namespace barchan
