#pragma once

#include <algorithm>
#include <cstddef>

#include <barchan/comm/slots/message.hpp>
#include <barchan/comm/slots/slot_exchange.hpp>

namespace barchan {

/// A rank's window, a block for each of its links:
///
///     words, halo and bulk   | 0 | 1 | 0 | 1 |     a cache line each
///     halo slots             | 0 | 1 |             header, payload, trailer; with a depth more
///     bulk slots             | 0 | 1 |
///
/// Links are the owner's: what is sent lands in the block of the receiver's link, so nothing is
/// confused where two links lead to the same rank. Where a block lies depends on its number only,
/// since ranks have different numbers of links. Each slot has its own word, since a neighbour may
/// announce n+1 before this rank has looked for n.
struct SlotLayout {
  static constexpr std::size_t kWordBytes = 64;

  SlotCapacity capacity;
  int num_links = 0;

  [[nodiscard]] constexpr std::size_t word(const MessageKey& key) const {
    return block(key.link) + kWordBytes * place(key);
  }
  [[nodiscard]] constexpr std::size_t slot(const MessageKey& key) const {
    const std::size_t at = place(key), halos = std::min(at, num_slots(Channel::Halo));
    return block(key.link) + words() + halos * slot_bytes(capacity.halo) +
           (at - halos) * slot_bytes(capacity.bulk);
  }
  [[nodiscard]] constexpr std::size_t total() const { return block(num_links); }

 private:
  [[nodiscard]] constexpr std::size_t num_slots(Channel channel) const {
    return static_cast<std::size_t>(capacity.slots(channel));
  }
  /// Among the slots of a link, halos first.
  [[nodiscard]] constexpr std::size_t place(const MessageKey& key) const {
    return (key.channel == Channel::Halo ? 0 : num_slots(Channel::Halo)) +
           static_cast<std::size_t>(capacity.slot(key));
  }
  [[nodiscard]] constexpr std::size_t words() const {
    return kWordBytes * (num_slots(Channel::Halo) + num_slots(Channel::Bulk));
  }
  [[nodiscard]] constexpr std::size_t block(int link) const {
    return static_cast<std::size_t>(link) *
           (words() + num_slots(Channel::Halo) * slot_bytes(capacity.halo) +
            num_slots(Channel::Bulk) * slot_bytes(capacity.bulk));
  }
};

}  // namespace barchan
