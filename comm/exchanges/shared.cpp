#include <atomic>
#include <vector>

#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/reduction.hpp>
#include <barchan/comm/base/window.hpp>
#include <barchan/comm/exchanges/all.hpp>
#include <barchan/comm/slots/slot_layout.hpp>

namespace barchan {
namespace {

/// Memory that the ranks of a node share: the sender packs into its own slot and stores the number
/// into its own word (release); the reader looks at that word (acquire) and reads the slot in
/// place. No copy, and no MPI call for a message that is there. Who waits drives the library,
/// since reductions of others may depend on this rank meanwhile.
class SharedMemory final : public SlotExchange {
 public:
  using SlotExchange::SlotExchange;
  std::string_view name() const override { return "shared"; }
  /// Stores need nobody's help; reductions do where they go from rank to rank.
  bool needs_progress() const override {
    return communicator().size() > Reduction::kDefaultDirectRanks;
  }

 protected:
  void allocate(SlotCapacity capacity) override {
    if (!communicator().all_of(communicator().node_size() == communicator().size())) {
      throw InputError("exchange 'shared' needs all ranks on one node",
                       "use `--exchange shared+put-inband`, which shares memory within each node, "
                       "or `shared+isend` where no window can be made between nodes");
    }
    layout_ = SlotLayout{capacity, most_links()};
    window_ = Window(communicator(), layout_.total(), Window::Memory::Shared);
    window_.lock_all();
    theirs_.resize(static_cast<std::size_t>(neighbours().num_links()));
    for (int link = 0; link < neighbours().num_links(); ++link) {
      if (neighbours().has(link)) {
        theirs_[static_cast<std::size_t>(link)] = window_.base_of(neighbours().rank(link));
      }
    }
  }

  void retire() override { window_.free(); }

  std::byte* outbox(const MessageKey& key) override { return window_.base() + layout_.slot(key); }

  void post(const MessageKey& key, const MessageHeader& header) override {
    write_header(header, outbox(key));
    word(window_.base(), key).store(key.number, std::memory_order_release);
  }

  const std::byte* arrived(const MessageKey& key) override {
    const MessageKey at_sender = at_receiver(key);  // the other end's name for it
    std::byte* sender = theirs_[static_cast<std::size_t>(key.link)];
    if (word(sender, at_sender).load(std::memory_order_acquire) < key.number) {
      if (++num_empty_ % kEmptyPerProgress == 0) progress();
      return nullptr;
    }
    return sender + layout_.slot(at_sender);
  }

  std::string transport() const override { return "shared memory"; }

 private:
  [[nodiscard]] std::atomic_ref<std::uint64_t> word(std::byte* base, const MessageKey& key) const {
    return std::atomic_ref(*reinterpret_cast<std::uint64_t*>(base + layout_.word(key)));
  }

  static constexpr std::uint64_t kEmptyPerProgress = 16;

  Window window_;
  SlotLayout layout_;
  std::uint64_t num_empty_ = 0;
  std::vector<std::byte*> theirs_;  ///< by link
};

}  // namespace

std::unique_ptr<SlotExchange> make_shared_memory(const Communicator& communicator,
                                                 const Neighbours& neighbours) {
  return std::make_unique<SharedMemory>(communicator, neighbours);
}

}  // namespace barchan
