#include <barchan/comm/slots/two_sided_exchange.hpp>

#include <exception>
#include <memory>
#include <string>
#include <utility>

#include <barchan/comm/base/call_watch.hpp>
#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/mpi_session.hpp>

namespace barchan {
namespace {

void wait(MPI_Request& request) {
  check_watched("MPI_Wait", [&] { return MPI_Wait(&request, MPI_STATUS_IGNORE); });
}

}  // namespace

TwoSidedExchange::TwoSidedExchange(const Communicator& communicator, const Neighbours& neighbours)
    : SlotExchange(communicator, neighbours),
      inboxes_(num_positions()),
      outboxes_(num_positions()),
      num_exceptions_(std::uncaught_exceptions()) {}

// A send may still read its buffer, and a receive still fill one. Where the others cannot be waited
// for, the buffers are left to the library.
TwoSidedExchange::~TwoSidedExchange() {
  if (!is_mpi_initialized()) return;
  if (std::uncaught_exceptions() > num_exceptions_) {
    static_cast<void>(std::make_unique<Slots>(std::move(outboxes_)).release());
    static_cast<void>(std::make_unique<Slots>(std::move(inboxes_)).release());
    return;
  }
  for (auto& of_link : outboxes_) {
    for (Slot& each : of_link) {
      const CallWatch watch("MPI_Wait");
      MPI_Wait(&each.request, MPI_STATUS_IGNORE);
    }
  }
}

void TwoSidedExchange::allocate(SlotCapacity capacity) {
  for (const Channel channel : {Channel::Halo, Channel::Bulk}) {
    for (int link = 0; link < neighbours().num_links(); ++link) {
      if (!neighbours().has(link)) continue;
      for (Slots* boxes : {&inboxes_, &outboxes_}) {
        auto& slots = (*boxes)[index({channel, link, 0})];
        slots.resize(static_cast<std::size_t>(capacity.slots(channel)));
        for (Slot& each : slots) each.memory.resize(slot_bytes(capacity.of(channel)));
      }
    }
  }
}

void TwoSidedExchange::retire() {
  for (auto& of_link : outboxes_) {
    for (Slot& each : of_link) wait(each.request);
  }
}

// The message that used this slot last has been received, so its send completes without the
// neighbour.
std::byte* TwoSidedExchange::outbox(const MessageKey& key) {
  Slot& mine = outboxes_[index(key)][slot(key)];
  wait(mine.request);
  return mine.memory.data();
}

void TwoSidedExchange::post(const MessageKey& key, const MessageHeader& header) {
  Slot& mine = outboxes_[index(key)][slot(key)];
  write_header(header, mine.memory.data());
  check(MPI_Isend(mine.memory.data(), mpi_count(kHeaderBytes + header.bytes), MPI_BYTE,
                  neighbour(key), at_receiver(key).position(), communicator().handle(),
                  &mine.request),
        "MPI_Isend");
}

void TwoSidedExchange::require_whole(const MessageKey& key, const MPI_Status& status) {
  int count = 0;
  check(MPI_Get_count(&status, MPI_BYTE, &count), "MPI_Get_count");
  const auto came = static_cast<std::size_t>(count);
  if (came >= kHeaderBytes && read_header(inbox(key).memory.data()).bytes == came - kHeaderBytes)
    return;
  throw RunError("rank " + std::to_string(communicator().rank()) + ": " +
                 describe(key, neighbour(key)) + " has " + std::to_string(came) +
                 " bytes, which its header contradicts");
}

}  // namespace barchan
