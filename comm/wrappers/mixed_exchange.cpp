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
                             Neighbours neighbours, const ExchangeOptions& options, Make make)
    : name_(mix.near + "+" + mix.far) {
  const Place place{nodes_of_ranks(communicator),
                    nodes_of_ranks(communicator, options.hooks.ranks_per_node),
                    communicator.rank()};
  const Links links = count_links(communicator, neighbours, options.hooks.ranks_per_node);
  const bool left_is_near = place.is_near(neighbours.left);
  const bool right_is_near = place.is_near(neighbours.right);
  if (links.on_node > 0) {
    const Neighbours near{left_is_near ? place.on_node(neighbours.left) : -1,
                          right_is_near ? place.on_node(neighbours.right) : -1};
    // The real node: Open MPI takes windows of two communicators on one node for the same.
    const Communicator node = communicator.split(static_cast<int>(place.node()));
    parts_[0] = made_on_all(communicator, [&] { return make(mix.near, node, near, options); });
  }
  if (links.on_node < links.all || links.all == 0) {
    const Neighbours far{left_is_near ? -1 : neighbours.left,
                         right_is_near ? -1 : neighbours.right};
    parts_[1] = make(mix.far, communicator, far, options);
  }
  for (const Side side : kSides) {
    const bool is_near = place.is_near(neighbours.rank(side));
    Exchange* mine = parts_[is_near ? 0 : 1].get();
    of_side_[index_of(side)] = mine != nullptr ? mine : parts_[0].get();
  }
}

void MixedExchange::reserve(std::size_t bytes) {
  for (const auto& part : parts_) {
    if (part) part->reserve(bytes);
  }
}

void MixedExchange::begin_bulk(std::span<const std::byte> to_left,
                               std::span<const std::byte> to_right) {
  for (const auto& part : parts_) {
    if (!part) continue;
    const auto share = [&](Side side, std::span<const std::byte> bytes) {
      return &of(side) == part.get() ? bytes : std::span<const std::byte>{};
    };
    part->begin_bulk(share(Side::Left, to_left), share(Side::Right, to_right));
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
