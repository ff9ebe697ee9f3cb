#pragma once

#include <vector>

#include <barchan/comm/slots/exchange.hpp>
#include <barchan/comm/slots/message.hpp>

namespace barchan {

/// Bytes of payload that a slot of each channel holds, and how many slots there are, equal on every
/// rank.
struct SlotCapacity {
  std::size_t halo = 0;
  std::size_t bulk = 0;
  int depth = 0;  ///< messages of a link that may be under way beside the latest (Exchange)

  [[nodiscard]] constexpr std::size_t of(Channel channel) const {
    return channel == Channel::Halo ? halo : bulk;
  }
  /// Of a link and way.
  [[nodiscard]] constexpr int slots(Channel channel) const {
    return channel == Channel::Halo ? 2 * depth + 2 : 2;
  }
  [[nodiscard]] constexpr int slot(const MessageKey& key) const {
    return static_cast<int>(key.number % static_cast<std::uint64_t>(slots(key.channel)));
  }
};

/// What all exchanges have in common: numbers, headers, growth, bulk in fragments, figures. A
/// derived class says where messages lie and how they travel (the protected part).
///
/// Each channel has two slots per link and way; message n uses slot n mod 2. With a depth d halos
/// have 2d + 2 (below). Happens-before, A, B neighbours, one channel:
///
///     pack A(n) → post A(n) → arrived B(n) → release B(n)     and the same with A and B swapped
///     release of n → pack of n+1, on either rank              duty of the caller, or of the rounds
///
/// hence
///
///     release B(n−1) → pack B(n) → post B(n) → arrived A(n) → release A(n) → pack A(n+1)
///
/// When A packs n+1, B has released n−1, which was the last to use that slot, and A's own copy of
/// n−1 has left.
///
/// With a depth d the duty is: release of n−d → pack of n+1. When A packs n+1, it has B's n−d; when
/// B packed that, it had released A's n−2d−1, the last to use the slot of n+1.
///
/// Bulk: both neighbours send a fragment a round, empty or not, with a flag whether they have more;
/// rounds go on while either has more, so both see the same end. A slot's capacity grows with
/// reserve() to the largest bulk seen, so that steady rebuilds need one round.
class SlotExchange : public Exchange {
 public:
  SlotExchange(const Communicator& communicator, const Neighbours& neighbours);

  void reserve(std::size_t bytes) final;
  std::span<std::byte> outgoing(int link, std::size_t bytes) final;
  void send(int link) final;
  bool poll(int link) final;
  std::span<const std::byte> received(int link) const final;
  void release(int link) final;
  void begin_bulk(std::span<const std::span<const std::byte>> outgoing) final;
  void progress() override;
  bool poll_bulk() final;
  std::vector<std::byte>& bulk(int link) final {
    return bulk_links_[static_cast<std::size_t>(link)].in;
  }
  std::int64_t bulk_posted(int link) const final {
    return track(Channel::Bulk, link).header.posted;
  }
  ExchangeStats stats() const final;
  HaloTimes halo_times(int link) const final { return halo_times_[static_cast<std::size_t>(link)]; }

  /// First slots; collective. make_exchange calls it once. Errors, the same on every rank:
  /// InputError for slots that do not fit into memory.
  void start(SlotCapacity capacity);

 protected:
  /// Slots for `capacity` on every rank, empty; numbers start again at 1. Collective.
  virtual void allocate(SlotCapacity capacity) = 0;
  /// Gives up the slots; nothing is in flight. Collective; all ranks have done so before allocate
  /// is called.
  virtual void retire() = 0;
  /// Memory of slot_bytes(capacity) for the header and payload of the message to key.link.
  virtual std::byte* outbox(const MessageKey& key) = 0;
  /// Sends header and payload, which lie in the outbox.
  virtual void post(const MessageKey& key, const MessageHeader& header) = 0;
  /// The message from key.link, header first, once it is in; until then nullptr. Asked again until
  /// it is.
  virtual const std::byte* arrived(const MessageKey& key) = 0;
  /// Consumed.
  virtual void recycle(const MessageKey& /*key*/) {}
  virtual std::string transport() const = 0;
  /// Rounds for a bulk of which this rank needs `mine`. Zero: each pair of neighbours goes on for
  /// as long as it needs. Exchanges that move all ranks at once agree on one number.
  virtual std::size_t agree_rounds(std::size_t /*mine*/) { return 0; }

  [[nodiscard]] const Communicator& communicator() const { return communicator_; }
  [[nodiscard]] const Neighbours& neighbours() const { return neighbours_; }
  [[nodiscard]] SlotCapacity capacity() const { return capacity_; }

  static constexpr std::size_t index(const MessageKey& key) {
    return static_cast<std::size_t>(key.position());
  }
  /// Of the rank that has most: windows have one size, which the library may rely on.
  [[nodiscard]] int most_links() const { return most_links_; }
  /// Of all channels and links.
  [[nodiscard]] std::size_t num_positions() const {
    return static_cast<std::size_t>(kNumChannels * neighbours_.num_links());
  }
  /// A message that goes out, as its receiver sees it.
  [[nodiscard]] MessageKey at_receiver(const MessageKey& key) const {
    return {key.channel, neighbours_.peer(key.link), key.number};
  }
  /// Calls act(key) for all slots of every channel and link, by the first message of each.
  template <class Act>
  void for_each_slot(Act&& act) const {
    for_each_slot(neighbours_.num_links(), act);
  }
  template <class Act>
  void for_each_slot(int num_links, Act&& act) const {
    for (const Channel channel : {Channel::Halo, Channel::Bulk}) {
      for (int link = 0; link < num_links; ++link) {
        for (int n = 1; n <= capacity_.slots(channel); ++n)
          act(MessageKey{channel, link, static_cast<std::uint64_t>(n)});
      }
    }
  }
  /// Of a message among those of its channel and link.
  [[nodiscard]] std::size_t slot(const MessageKey& key) const {
    return static_cast<std::size_t>(capacity_.slot(key));
  }
  [[nodiscard]] std::size_t slots(const MessageKey& key) const {
    return static_cast<std::size_t>(capacity_.slots(key.channel));
  }

 private:
  struct Track {  // of one channel and link
    std::uint64_t sent = 0;
    std::uint64_t released = 0;
    std::size_t outgoing_bytes = 0;
    bool is_packing = false;
    bool is_in = false;
    std::span<const std::byte> payload;
    MessageHeader header;
  };
  struct BulkLink {
    std::vector<std::byte> out;
    std::size_t num_sent = 0;    // bytes
    std::size_t num_rounds = 0;  // that this rank needs
    std::size_t round = 0;       // fragments sent
    bool is_done = true;
    std::vector<std::byte> in;
  };

  Track& track(Channel channel, int link) { return tracks_[index(MessageKey{channel, link, 0})]; }
  const Track& track(Channel channel, int link) const {
    return tracks_[index(MessageKey{channel, link, 0})];
  }
  void require_neighbour(int link, const char* what) const;
  void require_room(SlotCapacity capacity) const;
  [[nodiscard]] bool bulk_is_done() const;
  std::byte* open_outbox(Channel channel, int link, std::size_t bytes);
  void post_message(Channel channel, int link, bool has_more);
  bool look_for(Channel channel, int link);
  void accept(const MessageKey& key, const std::byte* message);
  void release_message(Channel channel, int link);
  void prepare_bulk(int link, std::span<const std::byte> bytes);
  void send_fragment(int link);
  void advance_bulk(int link);

  Communicator communicator_;
  Neighbours neighbours_;
  int most_links_ = 0;
  SlotCapacity capacity_;
  std::vector<Track> tracks_;
  std::vector<BulkLink> bulk_links_;
  std::vector<HaloTimes> halo_times_;
  std::size_t largest_bulk_ = 0;
  std::int64_t bulk_begin_ = 0;
  ExchangeStats stats_;
};

}  // namespace barchan
