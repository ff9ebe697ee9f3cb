#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <barchan/comm/clock.hpp>
#include <barchan/comm/strips.hpp>
#include <barchan/comm/tape.hpp>
#include <barchan/comm/watchdog.hpp>
#include <barchan/core/error.hpp>
#include <barchan/tasks/strip.hpp>

namespace barchan {
namespace {

constexpr int kMinSlabs = 2;    // a particle lies in at most one band
constexpr int kRecutEvery = 8;  // rebuilds between looks at the balance
constexpr std::array<Side, 2> kSides{Side::Left, Side::Right};
constexpr std::size_t at(Side side) {
  return static_cast<std::size_t>(side);
}

}  // namespace

template <int Dim>
void Strip<Dim>::seed(const ParticleSet& set) {
  const Grid<Dim>& grid = world_.grid;
  std::vector<std::int64_t> counts(static_cast<std::size_t>(grid.num_slabs()), 0);
  std::vector<int> slabs(set.particles.size());
  for (std::size_t p = 0; p < set.particles.size(); ++p) {
    double x[3] = {set.particles[p].position[0], set.particles[p].position[1],
                   set.particles[p].position[2]};
    grid.wrap(x);
    slabs[p] = grid.coordinate(x, 0);
    ++counts[static_cast<std::size_t>(slabs[p])];
  }
  cuts_ = cut_equal(counts, total_lanes(), kMinSlabs);

  std::vector<std::int32_t> where;  // by id, only where there are bonds
  std::vector<std::pair<std::int64_t, std::size_t>> by_id;
  std::vector<double> lengths;
  std::vector<char> bonded(set.particles.size(), 0);
  if (!set.bonds.empty()) {
    for (std::size_t p = 0; p < set.particles.size(); ++p)
      by_id.emplace_back(set.particles[p].id, p);
    std::sort(by_id.begin(), by_id.end());
    const auto find = [&](std::int64_t id) {
      return std::lower_bound(by_id.begin(), by_id.end(),
                              std::pair<std::int64_t, std::size_t>(id, 0))
          ->second;
    };
    for (const BondData& b : set.bonds) {
      const std::size_t p = find(b.id_a), q = find(b.id_b);
      bonded[p] = bonded[q] = 1;
      double d2 = 0.0;
      for (int c = 0; c < Dim; ++c) {
        double d = set.particles[q].position[c] - set.particles[p].position[c];
        d -= grid.box().length[c] * std::rint(d * grid.box().inverse[c]);
        d2 += d * d;
      }
      lengths.push_back(std::sqrt(d2));
    }
  }
  for (int l = 0; l < num_lanes(); ++l) {
    const int begin = cuts_[static_cast<std::size_t>(first_lane() + l)],
              end = cuts_[static_cast<std::size_t>(first_lane() + l + 1)];
    std::vector<ParticleData> mine;
    std::vector<char> mine_bonded;
    for (std::size_t p = 0; p < set.particles.size(); ++p) {
      if (slabs[p] < begin || slabs[p] >= end) continue;
      mine.push_back(set.particles[p]);
      mine_bonded.push_back(bonded[p]);
    }
    lane(l).seed(begin, end, mine, set.bonds, lengths, mine_bonded);
    lane(l).order();
  }
  const ForEachLane one_by_one = [this](const std::function<void(int)>& body) {
    for (int l = 0; l < num_lanes(); ++l) body(l);
  };
  exchange_ghosts(one_by_one);
  for (const auto& lane : lanes_) {
    lane->restart_search_seconds();  // setting up is not part of the loop
    lane->forget_imbalance();
  }
}

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
  for (const Side side : kSides) {
    if (!awaits(side) || (returns_ && side == Side::Right)) continue;
    wait_halo(side);
    exchange_->release(side);
  }
  awaited_ = {};
  count_wait(waits_.halo, Trace::Slice::Wait, begin);
}

template <int Dim>
void Strip<Dim>::count_wait(double& seconds, Trace::Slice name, std::int64_t begin) {
  const std::int64_t end = now_ns();
  seconds += 1e-9 * static_cast<double>(end - begin);
  if (trace_ != nullptr) trace_->slice(name, 0, begin, end);
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
  count_wait(waits_.migration, Trace::Slice::Reduction, begin);
  cuts_ = barchan::recut(cuts_, counts, total_lanes(), kMinSlabs);
}

template <int Dim>
void Strip<Dim>::migrate(const ForEachLane& parallel) {
  parallel([this](int l) {
    const auto place = static_cast<std::size_t>(first_lane() + l);
    auto& out = posts_[static_cast<std::size_t>(l)].out;
    lane(l).begin_rebuild(cuts_[place], cuts_[place + 1], out[0], out[1]);
  });
  const Bytes none;
  const auto outgoing = [&](Side side) -> const Bytes& {
    return neighbours_.has(side) ? posts_[side == Side::Left ? 0 : posts_.size() - 1].out[at(side)]
                                 : none;
  };
  bulk_begin_ = now_ns();
  if (exchange_) exchange_->begin_bulk(outgoing(Side::Left), outgoing(Side::Right));
  if (neighbours_.has(Side::Left) || neighbours_.has(Side::Right)) {
    for (int l = 0; l < num_lanes(); ++l) num_migrations_ += lane(l).num_leaving();
  }
  parallel([this](int l) {
    for (const Side side : kSides) {
      if (!has_neighbour(l, side) || (is_outer(l, side) && neighbours_.has(side))) continue;
      const int n = num_lanes(), other = (l + (side == Side::Left ? n - 1 : 1)) % n;
      lane(l).absorb(posts_[static_cast<std::size_t>(other)].out[at(opposite(side))]);
    }
  });
  if (exchange_) {
    discard_pending();
    const std::int64_t begin = now_ns();
    wait_bulk("migration");
    count_wait(waits_.migration, Trace::Slice::Migration, begin);
    if (neighbours_.has(Side::Left)) lane(0).absorb(exchange_->bulk(Side::Left));
    if (neighbours_.has(Side::Right)) lane(num_lanes() - 1).absorb(exchange_->bulk(Side::Right));
  }
  parallel([this](int l) { lane(l).order(); });
}

template <int Dim>
void Strip<Dim>::exchange_ghosts(const ForEachLane& parallel) {
  parallel([this](int l) {
    for (const Side side : kSides) {
      auto& out = posts_[static_cast<std::size_t>(l)].out[at(side)];
      out.clear();
      if (has_neighbour(l, side))
        lane(l).pack_ghosts(side == Side::Left ? Lane<Dim>::Left : Lane<Dim>::Right, out);
    }
  });
  const Bytes none;
  const auto outgoing = [&](Side side) -> const Bytes& {
    return neighbours_.has(side) ? posts_[side == Side::Left ? 0 : posts_.size() - 1].out[at(side)]
                                 : none;
  };
  bulk_begin_ = now_ns();
  if (exchange_) exchange_->begin_bulk(outgoing(Side::Left), outgoing(Side::Right));
  parallel([this](int l) { lane(l).list_owned(); });  // the messages travel meanwhile
  if (exchange_ && !returns_) begin_sizes();
  if (exchange_) {
    const std::int64_t begin = now_ns();
    wait_bulk("ghosts");
    count_wait(waits_.ghosts, Trace::Slice::Ghosts, begin);
  }
  parallel([this, &none](int l) {
    const auto incoming = [&](Side side) -> std::span<const std::byte> {
      if (!has_neighbour(l, side)) return none;
      if (is_outer(l, side) && neighbours_.has(side)) return exchange_->bulk(side);
      const int n = num_lanes(), other = (l + (side == Side::Left ? n - 1 : 1)) % n;
      return posts_[static_cast<std::size_t>(other)].out[at(opposite(side))];
    };
    lane(l).take_ghosts(incoming(Side::Left), incoming(Side::Right));
    lane(l).restore_history();
    lane(l).cut_chunks(chunk_pairs);
  });
  reserve_posts();
  fresh_ = true;
  awaited_ = {};
  // In the published scheme results come back even where ghosts are fresh.
  if (returns_) awaited_[at(Side::Right)] = neighbours_.has(Side::Right);
  if (!exchange_) return;
  if (returns_) begin_sizes();  // sizes of results follow from the lists
  const std::int64_t begin = now_ns();
  sizes_.wait();
  count_wait(waits_.ghosts, Trace::Slice::Reduction, begin);
  exchange_->reserve(static_cast<std::size_t>(sizes_.maxima()[0]));
}

/// Steps must not allocate.
template <int Dim>
void Strip<Dim>::reserve_posts() {
  for (int l = 0; l < num_lanes(); ++l) {
    for (const Side side : kSides) {
      const std::size_t bytes =
          lane(l).halo_bytes(side == Side::Left ? Lane<Dim>::Left : Lane<Dim>::Right);
      for (auto& boxes : posts_[static_cast<std::size_t>(l)].halo) boxes[at(side)].reserve(bytes);
    }
  }
  if (!returns_) return;
  results_.reserve(std::max(lane(0).max_results_bytes(Lane<Dim>::Left),
                            lane(num_lanes() - 1).max_results_bytes(Lane<Dim>::Right)) /
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
  std::size_t most = std::max(first.halo_bytes(Lane<Dim>::Left), last.halo_bytes(Lane<Dim>::Right));
  if (returns_)
    most = std::max(
        {most, first.max_results_bytes(Lane<Dim>::Left), last.max_results_bytes(Lane<Dim>::Right)});
  return most;
}

template class Strip<2>;
template class Strip<3>;

}  // namespace barchan
