#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <barchan/comm/base/clock.hpp>
#include <barchan/comm/base/tape.hpp>
#include <barchan/comm/base/watchdog.hpp>
#include <barchan/comm/topology/strips.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/tasks/strip.hpp>

namespace barchan {
namespace {

constexpr int kRecutEvery = 8;  // rebuilds between looks at the balance

}  // namespace

template <int Dim>
void Strip<Dim>::rebuild(const ForEachLane& parallel) {
  // A halo that is on its way is of no use any more. Where the exchange allows it, it is waited for
  // behind migration.
  const bool sides_go_together = exchange_ && !exchange_->allows_uneven_sides();
  if (sides_go_together) discard_pending();
  ++num_rebuilds_;
  if (num_rebuilds_ % kRecutEvery == 0 && total_lanes() > 1) recut();
  migrate(parallel);
  exchange_ghosts(parallel);
}

template <int Dim>
void Strip<Dim>::discard_pending() {
  const std::int64_t begin = now_ns();
  std::int64_t posted = 0;
  for (const Side side : kSides) {
    if (!awaits(side) || (returns_ && side == Side::Right)) continue;
    wait_halo(side);
    posted = std::max(posted, posted_at(side));
    exchange_->release(side);
  }
  awaited_ = {};
  count_wait(waits_.halo, Trace::Slice::Wait, begin, posted);
}

template <int Dim>
void Strip<Dim>::count_wait(double& seconds, Trace::Slice name, std::int64_t begin,
                            std::int64_t posted) {
  const std::int64_t end = now_ns();
  seconds += 1e-9 * static_cast<double>(end - begin);
  waits_.late +=
      1e-9 * static_cast<double>(std::clamp<std::int64_t>(posted - begin, 0, end - begin));
  if (trace_ != nullptr) trace_->slice(name, 0, begin, end);
}

template <int Dim>
std::int64_t Strip<Dim>::bulk_posted_at() const {
  std::int64_t last = 0;
  for (const Side side : kSides) {
    if (shares_clock_[index_of(side)]) last = std::max(last, exchange_->bulk_posted(side));
  }
  return last;
}

template <int Dim>
void Strip<Dim>::recut() {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(world_.grid.num_slabs()), 0);
  for (int l = 0; l < num_lanes(); ++l) {
    const auto& store = lane(l).store();
    for (std::int32_t i = 0; i < store.num_owned; ++i)
      ++counts[static_cast<std::size_t>(world_.grid.coordinate(store.x(i), 0))];
  }
  const std::int64_t begin = now_ns();
  taped_sum(communicator_, counts);
  count_wait(waits_.migration, Trace::Slice::Reduction, begin, 0);
  cuts_ = barchan::recut(cuts_, counts, total_lanes(), kMinSlabs);
}

template <int Dim>
void Strip<Dim>::migrate(const ForEachLane& parallel) {
  parallel([this](int l) {
    const auto place = static_cast<std::size_t>(first_lane() + l);
    auto& out = posts_[static_cast<std::size_t>(l)].out;
    lane(l).begin_rebuild(cuts_[place], cuts_[place + 1], out[0], out[1]);
  });
  begin_bulk();
  if (neighbours_.has(Side::Left) || neighbours_.has(Side::Right)) {
    for (int l = 0; l < num_lanes(); ++l) num_migrations_ += lane(l).num_leaving();
  }
  parallel([this](int l) {
    for (const Side side : kSides) {
      if (has_neighbour(l, side) && !is_remote(l, side)) lane(l).absorb(bulk(l, side));
    }
  });
  if (exchange_) {
    discard_pending();
    const std::int64_t begin = now_ns();
    wait_bulk("migration");
    count_wait(waits_.migration, Trace::Slice::Migration, begin, bulk_posted_at());
    if (neighbours_.has(Side::Left)) lane(0).absorb(exchange_->bulk(Side::Left));
    if (neighbours_.has(Side::Right)) lane(num_lanes() - 1).absorb(exchange_->bulk(Side::Right));
  }
  parallel([this](int l) { lane(l).order(); });
}

template <int Dim>
void Strip<Dim>::begin_bulk() {
  bulk_begin_ = now_ns();
  if (!exchange_) return;
  static const Bytes none;
  const auto outgoing = [&](Side side) -> const Bytes& {
    if (!neighbours_.has(side)) return none;
    return (side == Side::Left ? posts_.front() : posts_.back()).out[index_of(side)];
  };
  exchange_->begin_bulk(outgoing(Side::Left), outgoing(Side::Right));
}

template <int Dim>
std::span<const std::byte> Strip<Dim>::bulk(int l, Side side) const {
  if (!has_neighbour(l, side)) return {};
  if (is_remote(l, side)) return exchange_->bulk(side);
  return posts_[static_cast<std::size_t>(lane_beside(l, side))].out[index_of(opposite(side))];
}

template <int Dim>
void Strip<Dim>::exchange_ghosts(const ForEachLane& parallel) {
  parallel([this](int l) {
    for (const Side side : kSides) {
      auto& out = posts_[static_cast<std::size_t>(l)].out[index_of(side)];
      out.clear();
      if (has_neighbour(l, side)) lane(l).pack_ghosts(side, out);
    }
  });
  begin_bulk();
  parallel([this](int l) { lane(l).list_owned(); });  // the messages travel meanwhile
  if (exchange_ && !returns_) begin_sizes();
  if (exchange_) {
    const std::int64_t begin = now_ns();
    wait_bulk("ghosts");
    count_wait(waits_.ghosts, Trace::Slice::Ghosts, begin, bulk_posted_at());
  }
  parallel([this](int l) {
    lane(l).take_ghosts(bulk(l, Side::Left), bulk(l, Side::Right));
    lane(l).restore_history();
    lane(l).cut_chunks(chunk_pairs);
  });
  reserve_posts();
  set_fresh();
  awaited_ = {};
  // In the published scheme results come back even where ghosts are fresh.
  if (returns_) awaited_[index_of(Side::Right)] = neighbours_.has(Side::Right);
  if (!exchange_) return;
  if (returns_) begin_sizes();  // sizes of results follow from the lists
  const std::int64_t begin = now_ns();
  sizes_.wait();
  count_wait(waits_.ghosts, Trace::Slice::Reduction, begin, 0);
  exchange_->reserve(static_cast<std::size_t>(sizes_.maxima()[0]));
}

/// Steps must not allocate.
template <int Dim>
void Strip<Dim>::reserve_posts() {
  for (int l = 0; l < num_lanes(); ++l) {
    for (const Side side : kSides) {
      const std::size_t bytes = lane(l).halo_bytes(side);
      for (auto& boxes : posts_[static_cast<std::size_t>(l)].halo)
        boxes[index_of(side)].reserve(bytes);
    }
  }
  if (!returns_) return;
  results_.reserve(std::max(lane(0).results_bytes(Side::Left),
                            lane(num_lanes() - 1).results_bytes(Side::Right)) /
                   sizeof(double));
}

template <int Dim>
void Strip<Dim>::begin_sizes() {
  const double most = static_cast<double>(most_halo_bytes());
  sizes_.begin(std::span(&most, 1), {});
}

template <int Dim>
void Strip<Dim>::wait_bulk(const char* what) {
  wait_until(
      [this] {
        if (sizes_.is_in_flight()) (void)sizes_.test();
        return exchange_->poll_bulk();
      },
      [this, what] {
        std::string from;
        for (const Side side : kSides) {
          if (!neighbours_.has(side)) continue;
          from += fmt::format("{} rank {} ({})", from.empty() ? "from" : " or",
                              neighbours_.rank(side), name_of(side));
        }
        return fmt::format("rank {}: {} of step {} {}", communicator_.rank(), what, step, from);
      });
  waits_.in_flight += 1e-9 * static_cast<double>(now_ns() - bulk_begin_);
}

template <int Dim>
std::size_t Strip<Dim>::most_halo_bytes() const {
  const Lane<Dim>&first = lane(0), &last = lane(num_lanes() - 1);
  std::size_t most = std::max(first.halo_bytes(Side::Left), last.halo_bytes(Side::Right));
  if (returns_)
    most = std::max({most, first.results_bytes(Side::Left), last.results_bytes(Side::Right)});
  return most;
}

template class Strip<2>;
template class Strip<3>;

}  // namespace barchan
