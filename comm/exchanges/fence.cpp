#include <algorithm>
#include <exception>

#include <barchan/comm/base/call_watch.hpp>
#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/comm/base/window.hpp>
#include <barchan/comm/exchanges/all.hpp>
#include <barchan/comm/slots/slot_layout.hpp>

namespace barchan {
namespace {

/// Fence, put, fence: one window per channel, and the n-th fence of all ranks closes message n of
/// all.
/// The fence is called by the first poll after all links have been sent; it waits for every rank,
/// so this exchange hides little, all links go in step (no `return` scheme), every rank has a
/// neighbour, and halo and bulk are not in flight at the same time.
class Fence final : public SlotExchange {
 public:
  Fence(const Communicator& communicator, const Neighbours& neighbours)
      : SlotExchange(communicator, neighbours), num_exceptions_(std::uncaught_exceptions()) {}

  ~Fence() override {
    if (!is_mpi_initialized() || std::uncaught_exceptions() > num_exceptions_) return;
    try {
      retire();
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): nothing is left to be saved
    }
  }

  std::string_view name() const override { return "fence"; }
  bool is_blocking() const override { return true; }
  bool allows_uneven_sides() const override { return false; }

 protected:
  void allocate(SlotCapacity capacity) override {
    layout_ = SlotLayout{capacity, most_links()};
    outboxes_.resize(num_positions());
    num_posted_.assign(num_positions(), 0);
    num_fences_ = {};
    for (Window& window : windows_) {
      window = Window(communicator(), layout_.total());
      close(window, MPI_MODE_NOPRECEDE);
    }
    for (const Channel channel : {Channel::Halo, Channel::Bulk}) {
      for (int link = 0; link < neighbours().num_links(); ++link) {
        outboxes_[index({channel, link, 0})].resize(slot_bytes(capacity.of(channel)));
      }
    }
  }

  void retire() override {
    for (Window& window : windows_) {
      if (window.handle() == MPI_WIN_NULL) continue;
      close(window, MPI_MODE_NOSUCCEED);
      window.free();
    }
  }

  std::byte* outbox(const MessageKey& key) override { return outboxes_[index(key)].data(); }

  void post(const MessageKey& key, const MessageHeader& header) override {
    write_header(header, outbox(key));
    window(key).put({outbox(key), kHeaderBytes + header.bytes}, neighbours().rank(key.link),
                    layout_.slot(at_receiver(key)));
    num_posted_[index(key)] = key.number;
  }

  const std::byte* arrived(const MessageKey& key) override {
    std::uint64_t& num_fences = num_fences_[static_cast<std::size_t>(key.channel)];
    if (num_fences < key.number) {
      if (!has_sent_all(key)) return nullptr;
      close(window(key), 0);
      ++num_fences;
    }
    return window(key).base() + layout_.slot(key);
  }

  std::size_t agree_rounds(std::size_t mine) override {
    auto rounds = static_cast<std::int64_t>(mine);
    communicator().allreduce_max(std::span(&rounds, 1));
    return static_cast<std::size_t>(rounds);
  }

  std::string transport() const override { return "one-sided " + windows_[0].component(); }

 private:
  static void close(const Window& window, int assertion) {
    check_watched("MPI_Win_fence", [&] { return MPI_Win_fence(assertion, window.handle()); });
  }
  [[nodiscard]] bool has_sent_all(const MessageKey& key) const {
    for (int link = 0; link < neighbours().num_links(); ++link) {
      if (neighbours().has(link) && num_posted_[index({key.channel, link, 0})] < key.number)
        return false;
    }
    return true;
  }
  [[nodiscard]] const Window& window(const MessageKey& key) const {
    return windows_[static_cast<std::size_t>(key.channel)];
  }

  std::array<Window, kNumChannels> windows_;
  SlotLayout layout_;
  std::vector<std::vector<std::byte>> outboxes_;
  std::array<std::uint64_t, kNumChannels> num_fences_{};
  std::vector<std::uint64_t> num_posted_;
  int num_exceptions_;
};

}  // namespace

std::unique_ptr<SlotExchange> make_fence(const Communicator& communicator,
                                         const Neighbours& neighbours) {
  return std::make_unique<Fence>(communicator, neighbours);
}

}  // namespace barchan
