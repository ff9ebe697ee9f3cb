#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/comm/topology/neighbours.hpp>

namespace barchan {

/// What an exchange has moved so far on this rank.
struct ExchangeStats {
  std::string transport;            ///< "two-sided", "one-sided osc/sm", …
  std::uint64_t halo_messages = 0;  ///< sent
  std::uint64_t halo_bytes = 0;     ///< sent, payload
  std::uint64_t bulk_messages = 0;  ///< sent fragments
  std::uint64_t bulk_bytes = 0;     ///< sent, payload
  std::uint64_t growths = 0;        ///< times that slots grew after construction
  std::uint64_t halo_capacity = 0;  ///< bytes a halo message may have now
  std::uint64_t bulk_capacity = 0;  ///< bytes a fragment may have now
  /// Halo: own send until the neighbour's message of that number was noticed.
  double flight_seconds = 0.0;
  double bulk_seconds = 0.0;  ///< begin_bulk() until poll_bulk() was true

  [[nodiscard]] std::uint64_t messages() const { return halo_messages + bulk_messages; }
  [[nodiscard]] std::uint64_t bytes() const { return halo_bytes + bulk_bytes; }
};

/// Instants of the latest halo message on one link, steady clock [ns]; zero = not yet.
/// `posted` was read on the neighbour's clock: comparable within a node, to be aligned between
/// nodes.
struct HaloTimes {
  std::int64_t sent = 0;     ///< this rank's own message
  std::int64_t posted = 0;   ///< the neighbour's message, by its clock
  std::int64_t noticed = 0;  ///< poll() was true for the first time
};

/// One way of exchanging halo and bulk (migration, rebuild ghosts) messages with the
/// neighbours at the other ends of this rank's links.
///
/// Halo: the n-th message over a link meets the n-th from it; lengths may differ by message and
/// link. In time the links are free, in count they are not: in every step one message each way per
/// link. The order is
///
///     outgoing(n) → send(n)
///     poll(n) → received(n) → release(n) → outgoing(n + 1)
///
/// for each link. The last edge is the caller's duty; with it two slots per direction are enough
/// and no credits are needed (slot_exchange.hpp proves it). With ExchangeOptions::depth d it is
/// release(n − d) → outgoing(n + 1), and there are 2d + 2 slots. A breach throws std::logic_error.
///
/// One caller at a time. Construction, reserve and destruction are collective over the
/// communicator; destruction while an exception unwinds frees nothing that would wait for the
/// others. Errors: MpiError; RunError when a message is malformed or, in exchanges that block, does
/// not come within wait_limit().
class Exchange {
 public:
  virtual ~Exchange() = default;
  Exchange() = default;
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  [[nodiscard]] virtual std::string_view name() const = 0;

  /// Makes room for halo messages of `bytes`, the same number on every rank (the global maximum).
  /// Grows only. Collective when it grows, local and free when it need not. Between steps: every
  /// message sent has been received and released.
  virtual void reserve(std::size_t bytes) = 0;

  /// The buffer for the next halo message over a link; valid until send. @pre bytes <= reserved
  [[nodiscard]] virtual std::span<std::byte> outgoing(int link, std::size_t bytes) = 0;

  /// Starts the message; as early as possible. Does not wait for the neighbour.
  virtual void send(int link) = 0;

  /// True when the next message of a link is in; stays true until release. Never blocks, but in
  /// exchanges that is_blocking(). False without a neighbour there.
  [[nodiscard]] virtual bool poll(int link) = 0;

  /// @pre poll(link); valid until release
  [[nodiscard]] virtual std::span<const std::byte> received(int link) const = 0;

  /// Consumed: the next message may be looked for.
  virtual void release(int link) = 0;

  /// Starts messages of any length, by link (empty where nobody is); the spans may go when this
  /// returns. Local, but every rank does it equally often, and ends one before it begins
  /// the next.
  virtual void begin_bulk(std::span<const std::span<const std::byte>> outgoing) = 0;

  /// Lets what is under way advance, the neighbours' gets and large sends too; cheap. For a rank
  /// that has all it needs and still owes others theirs. Never blocks.
  virtual void progress() {}

  /// Whether a rank may need progress(): false where messages move without help.
  [[nodiscard]] virtual bool needs_progress() const { return true; }

  /// True when all links are complete, in and out.
  [[nodiscard]] virtual bool poll_bulk() = 0;

  /// What came over a link; the caller may take it away. @pre poll_bulk()
  [[nodiscard]] virtual std::vector<std::byte>& bulk(int link) = 0;

  /// When the neighbour sent the last part of the bulk that is in, by its clock (see HaloTimes).
  [[nodiscard]] virtual std::int64_t bulk_posted(int link) const = 0;

  [[nodiscard]] virtual ExchangeStats stats() const = 0;
  [[nodiscard]] virtual HaloTimes halo_times(int link) const = 0;

  /// Whether poll waits for the neighbour: such an exchange hides nothing.
  [[nodiscard]] virtual bool is_blocking() const { return false; }

  /// Whether a rank may wait for one link before it has sent over others, as the `return` scheme
  /// does.
  [[nodiscard]] virtual bool allows_uneven_sides() const { return true; }
};

/// What only tests ask for: a run must come to the same bits in spite of it.
struct ExchangeHooks {
  double max_delay_seconds = 0.0;  ///< hides arrived messages and holds sends up to this long
  std::uint64_t delay_seed = 0;
  int ranks_per_node = 0;  ///< this many ranks in a row count as a node; 0: the real nodes
};

struct ExchangeOptions {
  std::size_t halo_bytes = 4096;  ///< first size of the halo slots, equal on every rank
  std::size_t bulk_bytes =
      256 *
      1024;       ///< first size of a bulk fragment, equal on every rank; longer bulks go in rounds
  int depth = 0;  ///< halo messages of a link that may be under way beside the latest, see Exchange
  ExchangeHooks hooks{};
};

}  // namespace barchan
