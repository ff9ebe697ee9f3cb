#include <barchan/tasks/strip.hpp>

#include <algorithm>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include <barchan/comm/base/watchdog.hpp>
#include <barchan/comm/topology/links.hpp>
#include <barchan/core/base/clock.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/halo.hpp>

namespace barchan {
template <int Dim>
Strip<Dim>::Strip(World<Dim>& world, const Communicator& communicator,
                  std::unique_ptr<Exchange> exchange, int num_lanes, CutScheme scheme)
    : world_(world),
      communicator_(communicator),
      exchange_(std::move(exchange)),
      neighbours_(
          strip_neighbours(communicator.rank(), communicator.size(), world.grid.is_periodic(0))),
      scheme_(scheme),
      posts_(static_cast<std::size_t>(num_lanes)) {
  for (int l = 0; l < num_lanes; ++l) lanes_.emplace_back(world);
  place_bands();
  if (!exchange_) return;
  const auto nodes = nodes_of_ranks(communicator);
  const std::int64_t mine = nodes[static_cast<std::size_t>(communicator.rank())];
  for (const Side side : kSides) {
    shares_clock_[index_of(side)] =
        neighbours_.has(side) && nodes[static_cast<std::size_t>(neighbours_.rank(side))] == mine;
  }
}

template <int Dim>
bool Strip<Dim>::has_neighbour(int l, Side side) const {
  return !is_outer(l, side) || neighbours_.has(side) ||
         (communicator_.size() == 1 && num_lanes() > 1 && world_.grid.is_periodic(0));
}

template <int Dim>
auto Strip<Dim>::inbox(int l, Side side) const -> const Bytes& {
  return post(lane_beside(l, side))
      .halo[static_cast<std::size_t>(post(l).parity)][index_of(opposite(side))];
}

template <int Dim>
void Strip<Dim>::place_bands() {
  for (int l = 0; l < num_lanes(); ++l) {
    for (const Side side : kSides) {
      Band& band = lane(l).brick.band(side);
      band.exists = has_neighbour(l, side);
      band.returns = returns() && is_remote(l, side);
    }
  }
}

template <int Dim>
void Strip<Dim>::finish_band(int l, Side side) {
  Lane<Dim>& mine = lane(l);
  const Band& band = mine.brick.band(side);
  if (!is_remote(l, side)) {
    if (!post(l).is_fresh) unpack_halo(mine.brick, side, inbox(l, side));
    return mine.step.finish_band(side);
  }
  if (band.returns && side == Side::Right) {
    const auto message = exchange_->received(side);
    results_.resize(message.size() / sizeof(double));
    std::memcpy(results_.data(), message.data(), results_.size() * sizeof(double));
    exchange_->release(side);
    return mine.step.finish_right_band(results_);
  }
  if (awaits(side)) {
    unpack_halo(mine.brick, side, exchange_->received(side));
    exchange_->release(side);
  }
  mine.step.finish_band(side);
  if (!band.returns) return;
  take_results(mine.brick, results_);
  send_halo(side, results_.size() * sizeof(double), [&](std::span<std::byte> message) {
    std::memcpy(message.data(), results_.data(), message.size());
  });
}

/// Packing is work, the rest is the exchange's.
template <int Dim>
template <class Pack>
void Strip<Dim>::send_halo(Side side, std::size_t bytes, Pack&& pack) {
  const std::int64_t begin = now_ns();
  const auto message = exchange_->outgoing(side, bytes);
  const std::int64_t packing = now_ns();
  pack(message);
  const std::int64_t packed = now_ns();
  exchange_->send(side);
  send_ns_ += (packing - begin) + (now_ns() - packed);
}

template <int Dim>
void Strip<Dim>::set_exchange(std::unique_ptr<Exchange> exchange) {
  exchange_ = std::move(exchange);
  double most = static_cast<double>(most_halo_bytes());
  communicator_.allreduce_max(std::span(&most, 1));
  exchange_->reserve(static_cast<std::size_t>(most));
}

template <int Dim>
void Strip<Dim>::send_band(int l, Side side) {
  Lane<Dim>& mine = lane(l);
  if (is_remote(l, side)) {
    if (returns() && side == Side::Left) return;  // ghosts go right only
    return send_halo(side, halo_bytes(mine.brick, side),
                     [&](std::span<std::byte> message) { pack_halo(mine.brick, side, message); });
  }
  auto& outbox = post(l).halo[static_cast<std::size_t>(1 - post(l).parity)][index_of(side)];
  outbox.resize(halo_bytes(mine.brick, side));
  pack_halo(mine.brick, side, outbox);
}

template <int Dim>
void Strip<Dim>::end_step(int l) {
  post(l).parity = 1 - post(l).parity;
  post(l).is_fresh = false;
}

template <int Dim>
void Strip<Dim>::end_step() {
  halo_step_ = step + 1;
  for (const Side side : kSides) awaited_[index_of(side)] = neighbours_.has(side);
}

template <int Dim>
void Strip<Dim>::wait_halo(Side side) {
  wait_until([&] { return exchange_->poll(side); }, [&] { return name_of_halo(side); });
  if (trace_ != nullptr) trace_->noticed(side, halo_step_, now_ns());
}

template <int Dim>
std::string Strip<Dim>::name_of_halo(Side side) const {
  return fmt::format("rank {}: halo of step {} from rank {} ({})", communicator_.rank(), step,
                     neighbours_.rank(side), name_of(side));
}

template <int Dim>
void Strip<Dim>::complete_halo() {
  if (post(0).is_fresh) return;
  for (int l = 0; l < num_lanes(); ++l) {
    for (const Side side : kSides) {
      if (has_neighbour(l, side) && !is_remote(l, side))
        unpack_halo(lane(l).brick, side, inbox(l, side));
    }
  }
  for (const Side side : kSides) {
    if (!awaits_ghosts(side)) continue;
    wait_halo(side);
    unpack_halo(outer_lane(side).brick, side, exchange_->received(side));
    exchange_->release(side);
    awaited_[index_of(side)] = false;
  }
  set_fresh();
}

template <int Dim>
std::int64_t Strip<Dim>::discard_halo() {
  std::int64_t posted = 0;
  for (const Side side : kSides) {
    if (!awaits_ghosts(side)) continue;
    wait_halo(side);
    posted = std::max(posted, posted_at(side));
    exchange_->release(side);
  }
  awaited_ = {};
  return posted;
}

/// Steps must not allocate.
template <int Dim>
void Strip<Dim>::begin_lists() {
  for (int l = 0; l < num_lanes(); ++l) {
    for (const Side side : kSides) {
      for (auto& boxes : post(l).halo)
        boxes[index_of(side)].reserve(halo_bytes(lane(l).brick, side));
    }
  }
  set_fresh();
  awaited_ = {};
  if (!returns()) return;
  results_.reserve(most_results_bytes() / sizeof(double));
  // In the published scheme results come back even where ghosts are fresh.
  awaited_[index_of(Side::Right)] = neighbours_.has(Side::Right);
}

template <int Dim>
std::size_t Strip<Dim>::most_results_bytes() const {
  return std::max(results_bytes(lanes_.front().brick, Side::Left),
                  results_bytes(lanes_.back().brick, Side::Right));
}

template <int Dim>
std::size_t Strip<Dim>::most_halo_bytes() const {
  return std::max({halo_bytes(lanes_.front().brick, Side::Left),
                   halo_bytes(lanes_.back().brick, Side::Right),
                   returns() ? most_results_bytes() : 0});
}

template <int Dim>
std::int64_t Strip<Dim>::num_owned() const {
  std::int64_t n = 0;
  for (const Lane<Dim>& lane : lanes_) n += lane.brick.store.num_owned;
  return n;
}

template <int Dim>
std::pair<double, double> Strip<Dim>::extent() const {
  if (num_owned() == 0) return {0.0, 0.0};
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::pair<double, double> extent{kFar, -kFar};
  for (const Lane<Dim>& lane : lanes_) {
    const auto& store = lane.brick.store;
    for (std::int32_t i = 0; i < store.num_owned; ++i) {
      const double at = world_.grid.along_strips(store.x(i));
      extent = {std::min(extent.first, at), std::max(extent.second, at)};
    }
  }
  return extent;
}

template <int Dim>
std::size_t Strip<Dim>::bytes() const {
  std::size_t n = 0;
  for (const Lane<Dim>& lane : lanes_) n += lane.bytes();
  return n;
}

template class Strip<2>;
template class Strip<3>;

}  // namespace barchan
