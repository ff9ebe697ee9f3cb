#include <barchan/comm/wrappers/mixed_exchange.hpp>

#include <algorithm>

#include <barchan/comm/topology/links.hpp>
#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

/// Where this rank and its neighbours stand in their node.
struct Place {
  std::vector<std::int64_t> nodes;   ///< the real ones
  std::vector<std::int64_t> groups;  ///< of near ranks: the same, but in tests smaller
  int rank;

  [[nodiscard]] std::int64_t node() const { return nodes[static_cast<std::size_t>(rank)]; }
  [[nodiscard]] bool is_near(int other) const {
    return other >= 0 &&
           groups[static_cast<std::size_t>(other)] == groups[static_cast<std::size_t>(rank)];
  }
  /// The rank among those of this node.
  [[nodiscard]] int on_node(int other) const {
    return static_cast<int>(std::count(nodes.begin(), nodes.begin() + other, node()));
  }
};

/// Nodes may fail apart; all ranks then hear of the first failure.
template <class MakeIt>
std::unique_ptr<Exchange> made_on_all(const Communicator& communicator, MakeIt&& make_it) {
  std::unique_ptr<Exchange> exchange;
  std::string fault;
  try {
    exchange = make_it();
  } catch (const InputError& e) {
    fault = e.what();
  }
  const std::string first = communicator.first_error(fault);
  if (!first.empty()) throw InputError(first, "");  // it has its remedy
  return exchange;
}

}  // namespace

std::optional<ExchangeMix> ExchangeMix::parse(std::string_view name) {
  const auto plus = name.find('+');
  if (plus == std::string_view::npos) return std::nullopt;
  return ExchangeMix{std::string(name.substr(0, plus)), std::string(name.substr(plus + 1))};
}

MixedExchange::MixedExchange(const ExchangeMix& mix, const Communicator& communicator,
                             const Neighbours& neighbours, const ExchangeOptions& options,
                             Make make)
    : name_(mix.near + "+" + mix.far) {
  const Place place{nodes_of_ranks(communicator),
                    nodes_of_ranks(communicator, options.hooks.ranks_per_node),
                    communicator.rank()};
  const Links links = count_links(communicator, neighbours, options.hooks.ranks_per_node);
  // Both know all links by the same numbers, and miss those of the other.
  Neighbours near = neighbours, far = neighbours;
  for (int link = 0; link < neighbours.num_links(); ++link) {
    const int other = neighbours.rank(link);
    Link& missing = (place.is_near(other) ? far : near).links[static_cast<std::size_t>(link)];
    if (place.is_near(other))
      near.links[static_cast<std::size_t>(link)].rank = place.on_node(other);
    missing.rank = -1;
  }
  if (links.on_node > 0) {
    // The real node: Open MPI takes windows of two communicators on one node for the same.
    const Communicator node = communicator.split(static_cast<int>(place.node()));
    parts_[0] = made_on_all(communicator, [&] { return make(mix.near, node, near, options); });
  }
  if (links.on_node < links.all || links.all == 0)
    parts_[1] = make(mix.far, communicator, far, options);
  for (int link = 0; link < neighbours.num_links(); ++link) {
    Exchange* mine = parts_[place.is_near(neighbours.rank(link)) ? 0 : 1].get();
    of_link_.push_back(mine != nullptr ? mine : parts_[0].get());
  }
}

void MixedExchange::reserve(std::size_t bytes) {
  for (const auto& part : parts_) {
    if (part) part->reserve(bytes);
  }
}

void MixedExchange::begin_bulk(std::span<const std::span<const std::byte>> outgoing) {
  for (const auto& part : parts_) {
    if (!part) continue;
    std::vector<std::span<const std::byte>> share(of_link_.size());
    for (std::size_t link = 0; link < of_link_.size(); ++link) {
      if (of_link_[link] == part.get()) share[link] = outgoing[link];
    }
    part->begin_bulk(share);
  }
}

void MixedExchange::progress() {
  for (const auto& part : parts_) {
    if (part) part->progress();
  }
}

bool MixedExchange::needs_progress() const {
  return std::ranges::any_of(parts_,
                             [](const auto& part) { return part && part->needs_progress(); });
}

bool MixedExchange::poll_bulk() {
  bool all = true;
  for (const auto& part : parts_) {
    if (part && !part->poll_bulk()) all = false;
  }
  return all;
}

ExchangeStats MixedExchange::stats() const {
  ExchangeStats sum;
  for (const auto& part : parts_) {
    if (!part) continue;
    const ExchangeStats one = part->stats();
    sum.transport += (sum.transport.empty() ? "" : " and ") + one.transport;
    sum.halo_messages += one.halo_messages;
    sum.halo_bytes += one.halo_bytes;
    sum.bulk_messages += one.bulk_messages;
    sum.bulk_bytes += one.bulk_bytes;
    sum.growths = std::max(sum.growths, one.growths);
    sum.halo_capacity = std::max(sum.halo_capacity, one.halo_capacity);
    sum.bulk_capacity = std::max(sum.bulk_capacity, one.bulk_capacity);
    sum.flight_seconds += one.flight_seconds;
    sum.bulk_seconds = std::max(sum.bulk_seconds, one.bulk_seconds);
  }
  return sum;
}

bool MixedExchange::is_blocking() const {
  return std::ranges::any_of(parts_, [](const auto& part) { return part && part->is_blocking(); });
}

bool MixedExchange::allows_uneven_sides() const {
  return std::ranges::all_of(parts_,
                             [](const auto& part) { return !part || part->allows_uneven_sides(); });
}

}  // namespace barchan
