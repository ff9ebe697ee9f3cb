#include <barchan/comm/slots/message.hpp>

#include <cstring>

namespace barchan {

void write_header(const MessageHeader& header, std::byte* message) {
  std::memcpy(message, &header, kHeaderBytes);
}

MessageHeader read_header(const std::byte* message) {
  MessageHeader header;
  std::memcpy(&header, message, kHeaderBytes);
  return header;
}

std::string fault_of(const MessageHeader& header, std::uint64_t expected_number,
                     std::size_t at_most) {
  if (header.number != expected_number) {
    return "it carries the number " + std::to_string(header.number) + " instead of " +
           std::to_string(expected_number);
  }
  if (header.bytes > at_most) {
    return "it claims " + std::to_string(header.bytes) + " bytes where at most " +
           std::to_string(at_most) + " fit";
  }
  if (header.has_more > 1) return "its continuation flag is " + std::to_string(header.has_more);
  return {};
}

std::string describe(const MessageKey& key, int neighbour) {
  return std::string(key.channel == Channel::Halo ? "halo" : "bulk") + " message " +
         std::to_string(key.number) + " from rank " + std::to_string(neighbour) + " (link " +
         std::to_string(key.link) + ")";
}

}  // namespace barchan
