#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace barchan {

/// Halo and bulk messages travel in channels of their own: own slots, own sequence words, own
/// numbers.
enum class Channel : int { Halo = 0, Bulk = 1 };
inline constexpr int kNumChannels = 2;

/// Message `number` (from 1) of a channel, to or from the neighbour at a link.
struct MessageKey {
  Channel channel = Channel::Halo;
  int link = 0;
  std::uint64_t number = 0;

  /// Of its channel and link among all; also the tag of its receiver.
  [[nodiscard]] constexpr int position() const {
    return kNumChannels * link + static_cast<int>(channel);
  }
};

/// A message in memory; only some exchanges have a trailer:
///
///     | header, 64 bytes | payload … | trailer, 8 bytes |
struct MessageHeader {
  std::uint64_t number = 0;
  std::uint64_t bytes = 0;     ///< of payload
  std::uint64_t checksum = 0;  ///< of the payload, where an exchange wants one
  std::int64_t posted = 0;     ///< sender's steady clock [ns]
  std::uint64_t has_more = 0;  ///< bulk: 1 = the sender has further fragments
  std::uint64_t unused[3] = {};
};
static_assert(sizeof(MessageHeader) == 64);

inline constexpr std::size_t kHeaderBytes = sizeof(MessageHeader);
inline constexpr std::size_t kTrailerBytes =
    64;  ///< room for a trailer that keeps slots apart by cache lines

constexpr std::size_t round_to_line(std::size_t bytes) {
  return (bytes + 63) / 64 * 64;
}

/// Memory that a slot takes for payloads of up to `capacity` bytes.
constexpr std::size_t slot_bytes(std::size_t capacity) {
  return kHeaderBytes + round_to_line(capacity) + kTrailerBytes;
}

void write_header(const MessageHeader& header, std::byte* message);
[[nodiscard]] MessageHeader read_header(const std::byte* message);

/// Holds a header that came in against what must have come. `at_most` is the room for the payload.
/// Returns what is wrong with it, or nothing. Pure; any 64 bytes are safe.
[[nodiscard]] std::string fault_of(const MessageHeader& header, std::uint64_t expected_number,
                                   std::size_t at_most);

/// "halo message 17 from rank 2 (link 0)"
[[nodiscard]] std::string describe(const MessageKey& key, int neighbour);

}  // namespace barchan
