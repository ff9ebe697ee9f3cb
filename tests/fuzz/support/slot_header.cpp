#include "slot_header.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include <barchan/comm/slots/message.hpp>

namespace barchan::fuzz {

void read_slot_header(std::span<const std::byte> bytes) {
  constexpr std::size_t kRoom = 4096;
  std::byte header[kHeaderBytes] = {};
  std::memcpy(header, bytes.data(), std::min(bytes.size(), sizeof header));
  const MessageHeader read = read_header(header);
  if (fault_of(read, read.number, kRoom).empty() && read.bytes > kRoom) std::abort();
  (void)describe({Channel::Bulk, 1, read.number}, 3);
}

}  // namespace barchan::fuzz
