#include <barchan/comm/slots/slot_exchange.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>

#include <barchan/comm/base/memory_left.hpp>
#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/core/base/clock.hpp>
#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

constexpr std::size_t kLargestFragment = std::size_t{16} << 20;

}  // namespace

SlotExchange::SlotExchange(const Communicator& communicator, const Neighbours& neighbours)
    : communicator_(communicator.duplicate()),
      neighbours_(neighbours),
      tracks_(num_positions()),
      bulk_links_(static_cast<std::size_t>(neighbours.num_links())),
      halo_times_(static_cast<std::size_t>(neighbours.num_links())) {
  std::int64_t most = neighbours.num_links();
  communicator_.allreduce_max(std::span(&most, 1));
  most_links_ = static_cast<int>(most);
}

void SlotExchange::start(SlotCapacity capacity) {
  capacity_ = {round_to_line(capacity.halo),
               round_to_line(std::max<std::size_t>(capacity.bulk, 64)), capacity.depth};
  require_room(capacity_);
  allocate(capacity_);
}

// Memory that is not there is often granted, and missed only when it is touched.
void SlotExchange::require_room(SlotCapacity capacity) const {
  constexpr double most = 2147483647.0;  // one MPI call moves so much
  const double halo = static_cast<double>(capacity.halo), bulk = static_cast<double>(capacity.bulk);
  const double needed = 2.0 * std::max(1, most_links_) *  // each way
                        (capacity.slots(Channel::Halo) * halo + 2.0 * bulk);
  const bool fits =
      std::max(halo, bulk) + 128.0 <= most && needed * communicator_.node_size() <= memory_left();
  if (communicator_.all_of(fits)) return;
  throw InputError("messages of " + std::to_string(capacity.halo) + " bytes take " +
                       std::to_string(static_cast<std::int64_t>(needed / 1048576.0)) +
                       " MiB on every rank, which is more than this node has left or one MPI call "
                       "moves (2 GiB)",
                   "use smaller messages: more ranks, or for `barchan probe` a smaller --bytes");
}

void SlotExchange::reserve(std::size_t bytes) {
  if (bytes <= capacity_.halo) return;
  for (const Track& each : tracks_) {
    if (each.sent != each.released || each.is_packing) {
      throw std::logic_error("Exchange::reserve: a message is in flight");
    }
  }
  require_room({bytes + bytes / 2, capacity_.bulk, capacity_.depth});
  retire();
  std::int64_t largest_bulk = static_cast<std::int64_t>(largest_bulk_);
  communicator_.allreduce_max(std::span(&largest_bulk, 1));  // also: everybody has retired
  const auto wanted_bulk =
      std::min(static_cast<std::size_t>(largest_bulk) * 5 / 4, kLargestFragment);
  capacity_.halo = round_to_line(bytes + bytes / 2);
  capacity_.bulk = round_to_line(std::max(capacity_.bulk, wanted_bulk));
  tracks_.assign(tracks_.size(), {});
  allocate(capacity_);
  ++stats_.growths;
}

void SlotExchange::require_neighbour(int link, const char* what) const {
  if (!neighbours_.has(link)) [[unlikely]] {
    throw std::logic_error(std::string(what) + ": there is no neighbour at link " +
                           std::to_string(link));
  }
}

std::byte* SlotExchange::open_outbox(Channel channel, int link, std::size_t bytes) {
  require_neighbour(link, "Exchange::outgoing");
  Track& mine = track(channel, link);
  const auto depth = static_cast<std::uint64_t>(channel == Channel::Halo ? capacity_.depth : 0);
  if (mine.released + depth < mine.sent) [[unlikely]] {
    throw std::logic_error("Exchange::outgoing: the neighbour's message " +
                           std::to_string(mine.sent - depth) + " must be released before message " +
                           std::to_string(mine.sent + 1) + " is packed");
  }
  if (bytes > capacity_.of(channel)) [[unlikely]] {
    throw std::logic_error("Exchange::outgoing: " + std::to_string(bytes) +
                           " bytes are more than the " + std::to_string(capacity_.of(channel)) +
                           " reserved");
  }
  mine.outgoing_bytes = bytes;
  mine.is_packing = true;
  return outbox({channel, link, mine.sent + 1});
}

std::span<std::byte> SlotExchange::outgoing(int link, std::size_t bytes) {
  return {open_outbox(Channel::Halo, link, bytes) + kHeaderBytes, bytes};
}

void SlotExchange::post_message(Channel channel, int link, bool has_more) {
  Track& mine = track(channel, link);
  if (!mine.is_packing) [[unlikely]]
    throw std::logic_error("Exchange::send: no message was packed");
  const std::int64_t begin = now_ns();
  MessageHeader header;
  header.number = ++mine.sent;
  header.bytes = mine.outgoing_bytes;
  header.posted = begin;
  header.has_more = has_more ? 1 : 0;
  mine.is_packing = false;
  post({channel, link, header.number}, header);
  if (channel == Channel::Halo) halo_times_[static_cast<std::size_t>(link)].sent = begin;
}

void SlotExchange::send(int link) {
  post_message(Channel::Halo, link, false);
  ++stats_.halo_messages;
  stats_.halo_bytes += track(Channel::Halo, link).outgoing_bytes;
}

bool SlotExchange::look_for(Channel channel, int link) {
  if (!neighbours_.has(link)) return false;
  Track& mine = track(channel, link);
  if (mine.is_in) return true;
  const MessageKey key{channel, link, mine.released + 1};
  const std::byte* message = arrived(key);
  if (message == nullptr) return false;
  accept(key, message);
  return true;
}

void SlotExchange::accept(const MessageKey& key, const std::byte* message) {
  Track& mine = track(key.channel, key.link);
  mine.header = read_header(message);
  const std::string fault = fault_of(mine.header, key.number, capacity_.of(key.channel));
  if (!fault.empty()) [[unlikely]] {
    throw RunError("rank " + std::to_string(communicator_.rank()) + ": " +
                   describe(key, neighbours_.rank(key.link)) + " is damaged: " + fault);
  }
  mine.payload = {message + kHeaderBytes, static_cast<std::size_t>(mine.header.bytes)};
  mine.is_in = true;
}

bool SlotExchange::poll(int link) {
  const bool was_in = track(Channel::Halo, link).is_in;
  if (!look_for(Channel::Halo, link)) return false;
  if (was_in) return true;
  const Track& mine = track(Channel::Halo, link);
  HaloTimes& times = halo_times_[static_cast<std::size_t>(link)];
  times.noticed = now_ns();
  times.posted = mine.header.posted;
  if (mine.sent == mine.header.number)
    stats_.flight_seconds += to_seconds(times.noticed - times.sent);
  return true;
}

std::span<const std::byte> SlotExchange::received(int link) const {
  const Track& mine = track(Channel::Halo, link);
  if (!mine.is_in) [[unlikely]]
    throw std::logic_error("Exchange::received: no message is in");
  return mine.payload;
}

void SlotExchange::release(int link) {
  release_message(Channel::Halo, link);
}

void SlotExchange::release_message(Channel channel, int link) {
  Track& mine = track(channel, link);
  if (!mine.is_in) [[unlikely]]
    throw std::logic_error("Exchange::release: no message is in");
  mine.is_in = false;
  mine.payload = {};
  ++mine.released;
  recycle({channel, link, mine.released});
}

void SlotExchange::begin_bulk(std::span<const std::span<const std::byte>> outgoing) {
  if (!bulk_is_done())
    throw std::logic_error("Exchange::begin_bulk: the last bulk is not complete");
  bulk_begin_ = now_ns();
  std::size_t longest = 0;
  for (int link = 0; link < neighbours_.num_links(); ++link) {
    const auto bytes = outgoing[static_cast<std::size_t>(link)];
    longest = std::max(longest, bytes.size());
    prepare_bulk(link, bytes);
  }
  largest_bulk_ = std::max(largest_bulk_, longest);
  const std::size_t needed =
      std::max<std::size_t>(1, (longest + capacity_.bulk - 1) / capacity_.bulk);
  const std::size_t agreed = agree_rounds(needed);
  for (int link = 0; link < neighbours_.num_links(); ++link) {
    if (agreed > 0) bulk_links_[static_cast<std::size_t>(link)].num_rounds = agreed;
    if (neighbours_.has(link)) send_fragment(link);
  }
}

void SlotExchange::prepare_bulk(int link, std::span<const std::byte> bytes) {
  if (!bytes.empty()) require_neighbour(link, "Exchange::begin_bulk");
  BulkLink& mine = bulk_links_[static_cast<std::size_t>(link)];
  mine.out.assign(bytes.begin(), bytes.end());
  mine.in.clear();
  mine.num_sent = 0;
  mine.num_rounds = std::max<std::size_t>(1, (bytes.size() + capacity_.bulk - 1) / capacity_.bulk);
  mine.round = 0;
  mine.is_done = !neighbours_.has(link);
}

void SlotExchange::send_fragment(int link) {
  BulkLink& mine = bulk_links_[static_cast<std::size_t>(link)];
  const std::size_t bytes = std::min(capacity_.bulk, mine.out.size() - mine.num_sent);
  std::byte* outbox = open_outbox(Channel::Bulk, link, bytes) + kHeaderBytes;
  std::copy_n(mine.out.data() + mine.num_sent, bytes, outbox);
  mine.num_sent += bytes;
  ++mine.round;
  post_message(Channel::Bulk, link, mine.round < mine.num_rounds);
  ++stats_.bulk_messages;
  stats_.bulk_bytes += bytes;
}

// One round at most: in a ring of blocking exchanges a rank must serve all links in turn.
void SlotExchange::advance_bulk(int link) {
  BulkLink& mine = bulk_links_[static_cast<std::size_t>(link)];
  if (mine.is_done || !look_for(Channel::Bulk, link)) return;
  const Track& channel = track(Channel::Bulk, link);
  mine.in.insert(mine.in.end(), channel.payload.begin(), channel.payload.end());
  const bool they_have_more = channel.header.has_more != 0;
  release_message(Channel::Bulk, link);
  if (they_have_more || mine.round < mine.num_rounds) {
    send_fragment(link);
  } else {
    mine.is_done = true;
  }
}

void SlotExchange::progress() {
  int is_there = 0;
  check(
      MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, communicator_.handle(), &is_there, MPI_STATUS_IGNORE),
      "MPI_Iprobe");
}

bool SlotExchange::bulk_is_done() const {
  return std::ranges::all_of(bulk_links_, [](const BulkLink& link) { return link.is_done; });
}

bool SlotExchange::poll_bulk() {
  if (bulk_is_done()) return true;
  for (int link = 0; link < neighbours_.num_links(); ++link) advance_bulk(link);
  if (!bulk_is_done()) return false;
  stats_.bulk_seconds += seconds_since(bulk_begin_);
  return true;
}

ExchangeStats SlotExchange::stats() const {
  ExchangeStats all = stats_;
  all.transport = transport();
  all.halo_capacity = capacity_.halo;
  all.bulk_capacity = capacity_.bulk;
  return all;
}

}  // namespace barchan
