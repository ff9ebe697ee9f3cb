#include <exception>

#include <barchan/comm/base/call_watch.hpp>
#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/comm/exchanges/all.hpp>
#include <barchan/comm/slots/two_sided_exchange.hpp>

namespace barchan {
namespace {

/// Two-sided, non-blocking: all slots of each link have a persistent receive posted before the
/// message can come.
class Isend final : public TwoSidedExchange {
 public:
  using TwoSidedExchange::TwoSidedExchange;
  ~Isend() override {
    if (!is_mpi_initialized()) return;
    try {
      withdraw();
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): nothing is left to be saved
    }
  }
  std::string_view name() const override { return "isend"; }

 protected:
  void allocate(SlotCapacity capacity) override {
    TwoSidedExchange::allocate(capacity);
    for_each_slot([this](const MessageKey& key) {
      if (neighbours().has(key.link)) receive(key);
    });
  }

  void retire() override {
    TwoSidedExchange::retire();
    withdraw();
  }

  const std::byte* arrived(const MessageKey& key) override {
    int is_there = 0;
    MPI_Status status;
    check(MPI_Test(&inbox(key).request, &is_there, &status), "MPI_Test");
    if (is_there == 0) return nullptr;
    inbox(key).is_posted = false;
    require_whole(key, status);
    return inbox(key).memory.data();
  }

  void recycle(const MessageKey& key) override { start(inbox(key)); }

 private:
  static void start(Slot& slot) {
    check(MPI_Start(&slot.request), "MPI_Start");
    slot.is_posted = true;
  }

  void receive(const MessageKey& key) {
    Slot& slot = inbox(key);
    check(MPI_Recv_init(slot.memory.data(), mpi_count(slot.memory.size()), MPI_BYTE, neighbour(key),
                        key.position(), communicator().handle(), &slot.request),
          "MPI_Recv_init");
    start(slot);
  }

  void withdraw() {
    for (auto& of_link : inboxes()) {
      for (Slot& slot : of_link) {
        if (slot.request == MPI_REQUEST_NULL) continue;
        if (slot.is_posted) {
          check(MPI_Cancel(&slot.request), "MPI_Cancel");
          check_watched("MPI_Wait", [&] { return MPI_Wait(&slot.request, MPI_STATUS_IGNORE); });
          slot.is_posted = false;
        }
        check(MPI_Request_free(&slot.request), "MPI_Request_free");
      }
    }
  }
};

}  // namespace

std::unique_ptr<SlotExchange> make_isend(const Communicator& communicator,
                                         const Neighbours& neighbours) {
  return std::make_unique<Isend>(communicator, neighbours);
}

}  // namespace barchan
