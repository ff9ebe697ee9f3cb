#include <barchan/comm/exchanges/all.hpp>
#include <barchan/comm/slots/one_sided_exchange.hpp>

namespace barchan {
namespace {

/// Strict: put, flush, flag, flush. The flag never arrives before the message, on any network.
/// On a node four memory operations; over a network two round trips in which the sender is in MPI.
class PutFlag final : public OneSidedExchange {
 public:
  using OneSidedExchange::OneSidedExchange;
  std::string_view name() const override { return "put-flag"; }

 protected:
  void post(const MessageKey& key, const MessageHeader& header) override {
    std::byte* message = outbox(key);
    write_header(header, message);
    window().put({message, kHeaderBytes + header.bytes}, target(key),
                 layout().slot(at_receiver(key)));
    window().flush(target(key));
    put_word(key, key.number);
    window().flush(target(key));
  }

  const std::byte* arrived(const MessageKey& key) override {
    if (word(key) < key.number) {
      progress();
      if (word(key) < key.number) return nullptr;
    }
    window().sync();
    return inbox(key);
  }
};

}  // namespace

std::unique_ptr<SlotExchange> make_put_flag(const Communicator& communicator,
                                            const Neighbours& neighbours) {
  return std::make_unique<PutFlag>(communicator, neighbours);
}

}  // namespace barchan
