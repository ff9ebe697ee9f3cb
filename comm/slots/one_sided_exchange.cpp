#include <barchan/comm/slots/one_sided_exchange.hpp>

namespace barchan {

void OneSidedExchange::allocate(SlotCapacity capacity) {
  layout_ = SlotLayout{capacity, most_links()};
  local_.resize(num_positions());
  word_values_.resize(num_positions());
  window_ = Window(communicator(), layout_.total());
  window_.lock_all();
  is_unified_ = window_.is_unified();
  communicator().barrier();
  for (const Channel channel : {Channel::Halo, Channel::Bulk}) {
    for (int link = 0; link < neighbours().num_links(); ++link) {
      if (neighbours().has(link))
        local_[index({channel, link, 0})].assign(slot_bytes(capacity.of(channel)), std::byte{});
    }
  }
}

void OneSidedExchange::put_word(const MessageKey& key, std::uint64_t value) {
  std::uint64_t& origin = word_values_[index(key)];
  origin = value;
  window_.put(std::as_bytes(std::span(&origin, 1)), target(key), layout_.word(at_receiver(key)));
}

// A sync may be one more look at the network (osc/pt2pt), after every chunk.
void OneSidedExchange::progress() {
  SlotExchange::progress();
  if (!is_unified_) window_.sync();
}

}  // namespace barchan
