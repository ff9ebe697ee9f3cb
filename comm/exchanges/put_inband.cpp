#include <cstring>

#define XXH_INLINE_ALL  // no library to link
#include <xxhash.h>

#include <barchan/comm/exchanges/all.hpp>
#include <barchan/comm/slots/one_sided_exchange.hpp>

namespace barchan {
namespace {

/// The message tells itself that it is whole: its number before and after the payload, and a
/// checksum. One put, no remote flush, so over a network it takes one way instead of two round
/// trips.
///
/// MPI does not say in which order the bytes of a put land, so the reader believes a message only
/// when header and trailer carry its number and the checksum, seeded with the number, agrees; else
/// it looks again. MPI_Win_flush_local lets small puts leave at all (osc/pt2pt keeps them back),
/// and frees the outbox.
class PutInband final : public OneSidedExchange {
 public:
  using OneSidedExchange::OneSidedExchange;
  std::string_view name() const override { return "put-inband"; }

 protected:
  void post(const MessageKey& key, const MessageHeader& header) override {
    std::byte* message = outbox(key);
    MessageHeader sealed = header;
    sealed.checksum = checksum(message + kHeaderBytes, header);
    write_header(sealed, message);
    const std::size_t end = trailer_offset(header.bytes);
    std::memcpy(message + end, &key.number, sizeof(key.number));
    window().put({message, end + sizeof(key.number)}, target(key), layout().slot(at_receiver(key)));
    window().flush_local(target(key));
  }

  const std::byte* arrived(const MessageKey& key) override {
    if (is_whole(key)) return inbox(key);
    progress();
    return is_whole(key) ? inbox(key) : nullptr;
  }

 private:
  static std::size_t trailer_offset(std::uint64_t bytes) {
    return kHeaderBytes + (static_cast<std::size_t>(bytes) + 7) / 8 * 8;
  }

  // Covers the header too: its fields may land late as well.
  static std::uint64_t checksum(const std::byte* payload, MessageHeader header) {
    header.checksum =
        XXH3_64bits_withSeed(payload, static_cast<std::size_t>(header.bytes), header.number);
    return XXH3_64bits(&header, sizeof header);
  }

  [[nodiscard]] bool is_whole(const MessageKey& key) const {
    std::byte* message = inbox(key);
    const auto number_at = [message](std::size_t offset) {
      return std::atomic_ref(*reinterpret_cast<std::uint64_t*>(message + offset))
          .load(std::memory_order_acquire);
    };
    if (number_at(0) != key.number) return false;
    const MessageHeader header = read_header(message);
    if (header.bytes > capacity().of(key.channel) ||
        number_at(trailer_offset(header.bytes)) != key.number)
      return false;
    return header.checksum == checksum(message + kHeaderBytes, header);
  }
};

}  // namespace

std::unique_ptr<SlotExchange> make_put_inband(const Communicator& communicator,
                                              const Neighbours& neighbours) {
  return std::make_unique<PutInband>(communicator, neighbours);
}

}  // namespace barchan
