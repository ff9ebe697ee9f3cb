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
                  std::unique_ptr<Exchange> exchange, const LaneMap& map, CutScheme scheme)
    : world_(world),
      communicator_(communicator),
      exchange_(std::move(exchange)),
      map_(map),
      ties_(map.ties(communicator.rank())),
      neighbours_(neighbours_of(ties_)),
      scheme_(scheme),
      posts_(ties_.size()) {
  for (std::size_t l = 0; l < ties_.size(); ++l) lanes_.emplace_back(world);
  tie_lanes();
  awaited_.resize(ends_.size());
  const int depth = map.shape().depth;
  for (const LinkEnd& end : ends_) {
    shadows_.push_back(depth > 0 ? std::make_unique<Shadows<Dim>>(world, end.side, depth)
                                 : nullptr);
    deep_sent_at_.emplace_back(static_cast<std::size_t>(depth) + 2, 0);
  }
  shares_clock_.resize(ends_.size());
  if (!exchange_) return;
  const auto nodes = nodes_of_ranks(communicator);
  const std::int64_t mine = nodes[static_cast<std::size_t>(communicator.rank())];
  for (int link = 0; link < num_links(); ++link) {
    shares_clock_[static_cast<std::size_t>(link)] =
        nodes[static_cast<std::size_t>(neighbours_.rank(link))] == mine;
  }
}

template <int Dim>
void Strip<Dim>::tie_lanes() {
  for (int l = 0; l < num_lanes(); ++l) {
    Brick<Dim>& brick = lane(l).brick;
    brick.form = form();
    const int num_ties = static_cast<int>(ties(l).size());
    for (auto& boxes : post(l).halo) boxes.resize(static_cast<std::size_t>(num_ties));
    for (int t = 0; t < num_ties; ++t) {
      const LaneTie& tie = ties(l)[static_cast<std::size_t>(t)];
      brick.add_link(tie.side);
      if (tie.link < 0) continue;
      ends_.push_back({l, t, tie.side});
      brick.band(tie.side).returns = returns();
    }
    // Rows of a brick's rim are complete when both of its bands are done.
    for (Band& band : brick.bands)
      band.exists = band.exists || (form() == CutForm::Bricks && num_ties > 0);
  }
}

template <int Dim>
bool Strip<Dim>::has_left_link() const {
  return std::ranges::any_of(ends_, [](const LinkEnd& end) { return end.side == Side::Left; });
}

template <int Dim>
auto Strip<Dim>::inbox(int l, int tie) const -> const Bytes& {
  const LaneTie& from = ties(l)[static_cast<std::size_t>(tie)];
  return post(from.lane)
      .halo[static_cast<std::size_t>(post(l).parity)][static_cast<std::size_t>(from.back)];
}

template <int Dim>
void Strip<Dim>::take_halos(int l, Side side) {
  for (int t = 0; t < static_cast<int>(ties(l).size()); ++t) {
    if (ties(l)[static_cast<std::size_t>(t)].side == side) take_halo(l, t);
  }
}

template <int Dim>
void Strip<Dim>::take_halo(int l, int tie) {
  Brick<Dim>& brick = lane(l).brick;
  const LaneTie& from = ties(l)[static_cast<std::size_t>(tie)];
  if (from.link < 0) {
    if (!post(l).is_fresh) unpack_halo(brick, tie, inbox(l, tie));
    return;
  }
  if (!awaits(from.link)) return;
  if (const Shadows<Dim>* beyond = shadows(from.link))
    return unpack_halo(brick, tie, beyond->halo());
  const auto message = exchange_->received(from.link);
  if (returns() && from.side == Side::Right) {
    results_.resize(message.size() / sizeof(double));
    std::memcpy(results_.data(), message.data(), results_.size() * sizeof(double));
  } else {
    unpack_halo(brick, tie, message);
  }
  exchange_->release(from.link);
}

template <int Dim>
void Strip<Dim>::finish_band(int l, Side side) {
  Lane<Dim>& mine = lane(l);
  const bool returns = mine.brick.band(side).returns;
  if (returns && side == Side::Right) return mine.step.finish_right_band(results_);
  mine.step.finish_band(side);
  if (!returns) return;
  take_results(mine.brick, results_);
  for (const LaneTie& tie : ties(l)) {
    if (tie.link < 0 || tie.side != side) continue;
    send(tie.link, results_.size() * sizeof(double), [&](std::span<std::byte> message) {
      std::memcpy(message.data(), results_.data(), message.size());
    });
  }
}

/// Packing is work, the rest is the exchange's.
template <int Dim>
template <class Pack>
void Strip<Dim>::send(int link, std::size_t bytes, Pack&& pack) {
  const std::int64_t begin = now_ns();
  const auto message = exchange_->outgoing(link, bytes);
  const std::int64_t packing = now_ns();
  pack(message);
  sent_at_ = now_ns();
  exchange_->send(link);
  send_ns_ += (packing - begin) + (now_ns() - sent_at_);
}

template <int Dim>
void Strip<Dim>::set_exchange(std::unique_ptr<Exchange> exchange) {
  exchange_ = std::move(exchange);
  double most = static_cast<double>(most_halo_bytes());
  communicator_.allreduce_max(std::span(&most, 1));
  exchange_->reserve(static_cast<std::size_t>(most));
}

template <int Dim>
void Strip<Dim>::send_deep(int link) {
  const LinkEnd& end = end_of(link);
  const Brick<Dim>& brick = lane(end.lane).brick;
  shadows(link)->tell(brick, end.tie);
  const Rows rows = deep_rows(link);
  send(link, halo_bytes(brick, rows),
       [&](std::span<std::byte> message) { pack_halo(brick, rows, message); });
  auto& ring = deep_sent_at_[static_cast<std::size_t>(link)];
  ring[static_cast<std::size_t>(shadows(link)->steps()) % ring.size()] = sent_at_;
}

template <int Dim>
void Strip<Dim>::send_halo(int l, int tie) {
  const Brick<Dim>& brick = lane(l).brick;
  const LaneTie& to = ties(l)[static_cast<std::size_t>(tie)];
  if (to.link >= 0) {
    if (shadows(to.link) != nullptr) return send_deep(to.link);
    if (returns() && to.side == Side::Left) return;  // ghosts go right only
    return send(to.link, halo_bytes(brick, tie),
                [&](std::span<std::byte> message) { pack_halo(brick, tie, message); });
  }
  auto& outbox =
      post(l).halo[static_cast<std::size_t>(1 - post(l).parity)][static_cast<std::size_t>(tie)];
  outbox.resize(halo_bytes(brick, tie));
  pack_halo(brick, tie, outbox);
}

template <int Dim>
void Strip<Dim>::end_step(int l) {
  post(l).parity = 1 - post(l).parity;
  post(l).is_fresh = false;
}

template <int Dim>
void Strip<Dim>::end_step() {
  halo_step_ = step + 1;
  awaited_.assign(awaited_.size(), true);
}

template <int Dim>
void Strip<Dim>::wait_halo(int link) {
  wait_until([&] { return poll(link); }, [&] { return name_of_halo(link); });
  if (trace_ != nullptr && shadows(link) == nullptr) trace_->noticed(link, halo_step_, now_ns());
}

template <int Dim>
std::string Strip<Dim>::name_of_halo(int link) const {
  return fmt::format(
      "rank {}: halo of step {} from rank {}{}", communicator_.rank(), step, neighbours_.rank(link),
      form() == CutForm::Strips ? fmt::format(" ({})", name_of(end_of(link).side)) : std::string());
}

template <int Dim>
void Strip<Dim>::complete_halo() {
  if (post(0).is_fresh) return;
  for (int l = 0; l < num_lanes(); ++l) {
    for (int t = 0; t < static_cast<int>(ties(l).size()); ++t) {
      if (ties(l)[static_cast<std::size_t>(t)].link < 0) unpack_halo(lane(l).brick, t, inbox(l, t));
    }
  }
  for (int link = 0; link < num_links(); ++link) {
    if (!awaits_ghosts(link)) continue;
    wait_halo(link);
    Brick<Dim>& brick = lane(end_of(link).lane).brick;
    if (const Shadows<Dim>* beyond = shadows(link)) {
      unpack_halo(brick, end_of(link).tie, beyond->halo());
    } else {
      unpack_halo(brick, end_of(link).tie, exchange_->received(link));
      exchange_->release(link);
    }
    awaited_[static_cast<std::size_t>(link)] = false;
  }
  set_fresh();
}

template <int Dim>
std::int64_t Strip<Dim>::discard_halo() {
  std::int64_t posted = 0;
  for (int link = 0; link < num_links(); ++link) {
    if (shadows(link) != nullptr) {
      drain(link);
    } else if (awaits_ghosts(link)) {
      wait_halo(link);
      exchange_->release(link);
    } else {
      continue;
    }
    posted = std::max(posted, posted_at(link));
  }
  await_none();
  return posted;
}

/// Steps must not allocate.
template <int Dim>
void Strip<Dim>::begin_lists() {
  for (int l = 0; l < num_lanes(); ++l) {
    for (auto& boxes : post(l).halo) {
      for (std::size_t tie = 0; tie < boxes.size(); ++tie)
        boxes[tie].reserve(halo_bytes(lane(l).brick, static_cast<int>(tie)));
    }
  }
  set_fresh();
  await_none();
  lists_step_ = step;
  are_shadows_stale_ = false;
  if (!returns()) return;
  results_.reserve(most_results_bytes() / sizeof(double));
  // In the published scheme results come back even where ghosts are fresh.
  for (int link = 0; link < num_links(); ++link)
    awaited_[static_cast<std::size_t>(link)] = end_of(link).side == Side::Right;
}

template <int Dim>
std::size_t Strip<Dim>::most_results_bytes() const {
  return std::max(results_bytes(lanes_.front().brick, Side::Left),
                  results_bytes(lanes_.back().brick, Side::Right));
}

template <int Dim>
std::size_t Strip<Dim>::most_halo_bytes() const {
  std::size_t most = returns() ? most_results_bytes() : 0;
  for (int link = 0; link < num_links(); ++link) {
    const Brick<Dim>& brick = lane(end_of(link).lane).brick;
    most = std::max(most, shadows(link) == nullptr ? halo_bytes(brick, end_of(link).tie)
                                                   : halo_bytes(brick, deep_rows(link)));
  }
  return most;
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
  for (const auto& beyond : shadows_) n += beyond != nullptr ? beyond->bytes() : 0;
  return n;
}

template class Strip<2>;
template class Strip<3>;

}  // namespace barchan
