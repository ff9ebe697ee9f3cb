#include <exception>

#include <barchan/comm/base/call_watch.hpp>
#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/comm/base/window.hpp>
#include <barchan/comm/exchanges/all.hpp>

namespace barchan {
namespace {

/// Post, start, put, complete, test: active-target synchronisation, one window per slot of a link.
///
/// A slot's window is exposed to the one neighbour that writes it: for messages 1 and 2 from the
/// beginning, for n+2 when n is released. So the window that A starts on for n+1 has been posted
/// when B released n−1, which A knows from B's message n, and MPI_Win_start does not wait. With a
/// depth there are more slots, and the same holds (slot_exchange.hpp).
class Pscw final : public SlotExchange {
 public:
  Pscw(const Communicator& communicator, const Neighbours& neighbours)
      : SlotExchange(communicator, neighbours), num_exceptions_(std::uncaught_exceptions()) {
    groups_.resize(static_cast<std::size_t>(neighbours.num_links()), MPI_GROUP_NULL);
    for (int link = 0; link < neighbours.num_links(); ++link) make_group(link);
    outboxes_.resize(num_positions());
    num_posted_.resize(num_positions());
    num_recycled_.resize(num_positions());
    is_tested_.resize(num_positions());
    windows_.resize(static_cast<std::size_t>(kNumChannels * most_links()));
  }

  ~Pscw() override {
    if (!is_mpi_initialized() || std::uncaught_exceptions() > num_exceptions_) return;
    try {
      retire();
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): nothing is left to be saved
    }
    for (MPI_Group& group : groups_) {
      if (group != MPI_GROUP_NULL) MPI_Group_free(&group);
    }
  }

  std::string_view name() const override { return "pscw"; }

 protected:
  void allocate(SlotCapacity capacity) override {
    for_windows([&](const MessageKey& key) {
      windows_[index(key)].resize(slots(key));
      window(key) = Window(communicator(), slot_bytes(capacity.of(key.channel)));
      if (key.link >= neighbours().num_links()) return;
      expose(key);
      outboxes_[index(key)].resize(slot_bytes(capacity.of(key.channel)));
    });
  }

  // An exposure ends only by an access, so each window sees one more, empty, in each direction.
  void retire() override {
    take_in_the_last();
    for_windows([&](const MessageKey& key) {
      if (windows_[index(key)].empty()) return;
      Window& slot = window(key);
      if (slot.handle() == MPI_WIN_NULL) return;
      for (int link = 0; link < neighbours().num_links(); ++link) {
        if (!neighbours().has(link) || neighbours().peer(link) != key.link) continue;
        start(slot, link);
        complete(slot);
      }
      if (neighbours().has(key.link)) wait(slot);
      slot.free();
    });
    num_posted_.assign(num_positions(), 0);
    num_recycled_.assign(num_positions(), 0);
  }

  std::byte* outbox(const MessageKey& key) override { return outboxes_[index(key)].data(); }

  void post(const MessageKey& key, const MessageHeader& header) override {
    write_header(header, outbox(key));
    const Window& slot = window(at_receiver(key));
    start(slot, key.link);
    slot.put({outbox(key), kHeaderBytes + header.bytes}, neighbours().rank(key.link), 0);
    complete(slot);
    ++num_posted_[index(key)];
  }

  const std::byte* arrived(const MessageKey& key) override {
    int is_there = 0;
    check(MPI_Win_test(window(key).handle(), &is_there), "MPI_Win_test");
    is_tested_[index(key)] = is_there != 0 ? 1 : 0;
    return is_there != 0 ? window(key).base() : nullptr;
  }

  void recycle(const MessageKey& key) override {
    expose(key);
    ++num_recycled_[index(key)];
    is_tested_[index(key)] = 0;
  }

  std::string transport() const override { return "one-sided " + windows_[0][0].component(); }

 private:
  /// Of as many links as any rank has: windows are made by all.
  template <class Act>
  void for_windows(Act act) {
    for_each_slot(most_links(), act);
  }

  void start(const Window& slot, int link) const {
    check_watched("MPI_Win_start", [&] {
      return MPI_Win_start(groups_[static_cast<std::size_t>(link)], 0, slot.handle());
    });
  }
  static void complete(const Window& slot) {
    check_watched("MPI_Win_complete", [&] { return MPI_Win_complete(slot.handle()); });
  }
  static void wait(const Window& slot) {
    check_watched("MPI_Win_wait", [&] { return MPI_Win_wait(slot.handle()); });
  }

  /// A run may end with a message on its way from either link, whose access is then not yet over.
  void take_in_the_last() {
    for (const Channel channel : {Channel::Halo, Channel::Bulk}) {
      for (int link = 0; link < neighbours().num_links(); ++link) {
        const auto at = index({channel, link, 0});
        if (num_posted_[at] == num_recycled_[at]) continue;
        const MessageKey key{channel, link, num_recycled_[at] + 1};
        if (is_tested_[at] == 0) wait(window(key));
        recycle(key);
      }
    }
  }

  void make_group(int link) {
    if (!neighbours().has(link)) return;
    MPI_Group all = MPI_GROUP_NULL;
    const int rank = neighbours().rank(link);
    check(MPI_Comm_group(communicator().handle(), &all), "MPI_Comm_group");
    check(MPI_Group_incl(all, 1, &rank, &groups_[static_cast<std::size_t>(link)]),
          "MPI_Group_incl");
    check(MPI_Group_free(&all), "MPI_Group_free");
  }

  void expose(const MessageKey& key) {
    if (!neighbours().has(key.link)) return;
    check(MPI_Win_post(groups_[static_cast<std::size_t>(key.link)], 0, window(key).handle()),
          "MPI_Win_post");
  }

  Window& window(const MessageKey& key) { return windows_[index(key)][slot(key)]; }

  std::vector<std::vector<Window>> windows_;  ///< by channel and the receiver's link, by slot
  std::vector<std::vector<std::byte>> outboxes_;
  std::vector<MPI_Group> groups_;  ///< by link
  std::vector<std::uint64_t> num_posted_, num_recycled_;
  std::vector<char> is_tested_;  ///< in, not yet recycled
  int num_exceptions_;
};

}  // namespace

std::unique_ptr<SlotExchange> make_pscw(const Communicator& communicator,
                                        const Neighbours& neighbours) {
  return std::make_unique<Pscw>(communicator, neighbours);
}

}  // namespace barchan
