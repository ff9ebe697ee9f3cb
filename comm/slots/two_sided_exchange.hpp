#pragma once

#include <vector>

#include <barchan/comm/base/mpi_include.hpp>
#include <barchan/comm/slots/slot_exchange.hpp>

namespace barchan {

/// Common to the exchanges that send and receive. The tag names the channel and the receiver's
/// link, so that nothing is confused where both neighbours are the same rank.
class TwoSidedExchange : public SlotExchange {
 public:
  TwoSidedExchange(const Communicator& communicator, const Neighbours& neighbours);
  ~TwoSidedExchange() override;
  std::string_view name() const override = 0;

 protected:
  void allocate(SlotCapacity capacity) override;
  void retire() override;
  std::byte* outbox(const MessageKey& key) override;
  void post(const MessageKey& key, const MessageHeader& header) override;
  std::string transport() const override { return "two-sided"; }

  struct Slot {
    std::vector<std::byte> memory;
    MPI_Request request = MPI_REQUEST_NULL;
    bool is_posted = false;  // a persistent receive that is active
  };
  using Slots = std::vector<std::vector<Slot>>;  ///< by channel and link

  [[nodiscard]] Slots& inboxes() { return inboxes_; }
  [[nodiscard]] Slot& inbox(const MessageKey& key) { return inboxes_[index(key)][slot(key)]; }
  [[nodiscard]] int neighbour(const MessageKey& key) const { return neighbours().rank(key.link); }
  /// Holds the length that came in against the header's.
  void require_whole(const MessageKey& key, const MPI_Status& status);

 private:
  Slots inboxes_;
  Slots outboxes_;
  int num_exceptions_;
};

}  // namespace barchan
