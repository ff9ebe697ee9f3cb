#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/watchdog.hpp>
#include <barchan/comm/exchanges/all.hpp>
#include <barchan/comm/slots/two_sided_exchange.hpp>

namespace barchan {
namespace {

/// Two-sided, blocking, as in the published code: a message that is looked for is waited for, and
/// its receive is posted only then. Sends start buffered, so no order of ranks and sides can
/// deadlock. Hides nothing; the yardstick.
class Sendrecv final : public TwoSidedExchange {
 public:
  using TwoSidedExchange::TwoSidedExchange;
  std::string_view name() const override { return "sendrecv"; }
  bool is_blocking() const override { return true; }

 protected:
  // A blocking receive in all but one thing: a message that never comes is reported.
  const std::byte* arrived(const MessageKey& key) override {
    Slot& slot = inbox(key);
    check(MPI_Irecv(slot.memory.data(), mpi_count(slot.memory.size()), MPI_BYTE, neighbour(key),
                    key.position(), communicator().handle(), &slot.request),
          "MPI_Irecv");
    MPI_Status status;
    wait_until(
        [&] {
          int is_there = 0;
          check(MPI_Test(&slot.request, &is_there, &status), "MPI_Test");
          return is_there != 0;
        },
        [&] {
          return "rank " + std::to_string(communicator().rank()) + ": " +
                 describe(key, neighbour(key));
        });
    require_whole(key, status);
    return slot.memory.data();
  }
};

}  // namespace

std::unique_ptr<SlotExchange> make_sendrecv(const Communicator& communicator,
                                            const Neighbours& neighbours) {
  return std::make_unique<Sendrecv>(communicator, neighbours);
}

}  // namespace barchan
