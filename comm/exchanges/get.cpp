#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/exchanges/all.hpp>
#include <barchan/comm/slots/one_sided_exchange.hpp>

namespace barchan {
namespace {

/// The reader pulls. The sender packs into its own window and puts one word, number and length,
/// into the reader's; the reader then starts an MPI_Rget, which can be tested and completes at the
/// data: no flush waits in a step.
class Get final : public OneSidedExchange {
 public:
  using OneSidedExchange::OneSidedExchange;
  std::string_view name() const override { return "get"; }

 protected:
  std::byte* outbox(const MessageKey& key) override {
    return inbox(key);
  }  // slots hold what goes to key.link

  void post(const MessageKey& key, const MessageHeader& header) override {
    write_header(header, outbox(key));
    window().sync();
    put_word(key, announce(key.number, header.bytes));
    window().flush_local(target(key));
  }

  const std::byte* arrived(const MessageKey& key) override {
    MPI_Request& request = requests_[index(key)];
    if (request == MPI_REQUEST_NULL && !start(key)) return nullptr;
    int is_there = 0;
    check(MPI_Test(&request, &is_there, MPI_STATUS_IGNORE), "MPI_Test");
    return is_there != 0 ? local(key) : nullptr;
  }

 private:
  static constexpr int kLengthBits = 40;
  static constexpr std::uint64_t kLengthMask = (std::uint64_t{1} << kLengthBits) - 1;

  static constexpr std::uint64_t announce(std::uint64_t number, std::uint64_t bytes) {
    return number << kLengthBits | bytes;
  }

  bool start(const MessageKey& key) {
    if (!is_announced(key)) {
      progress();
      if (!is_announced(key)) return false;
    }
    window().sync();
    const auto bytes = static_cast<std::size_t>(word(key) & kLengthMask);
    if (bytes > capacity().of(key.channel))
      throw RunError(describe(key, target(key)) + " is longer than its slot");
    const int count = mpi_count(kHeaderBytes + bytes);
    check(MPI_Rget(local(key), count, MPI_BYTE, target(key),
                   static_cast<MPI_Aint>(layout().slot(at_receiver(key))), count, MPI_BYTE,
                   window().handle(), &requests_[index(key)]),
          "MPI_Rget");
    return true;
  }

  [[nodiscard]] bool is_announced(const MessageKey& key) const {
    return word(key) >> kLengthBits == announce(key.number, 0) >> kLengthBits;
  }

  std::vector<MPI_Request> requests_ = std::vector<MPI_Request>(num_positions(), MPI_REQUEST_NULL);
};

}  // namespace

std::unique_ptr<SlotExchange> make_get(const Communicator& communicator,
                                       const Neighbours& neighbours) {
  return std::make_unique<Get>(communicator, neighbours);
}

}  // namespace barchan
