#include <barchan/tasks/strip_rebuild.hpp>

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <barchan/comm/base/tape.hpp>
#include <barchan/comm/base/watchdog.hpp>
#include <barchan/core/base/bytes.hpp>
#include <barchan/core/base/clock.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/cell_order.hpp>
#include <barchan/core/brick/checkpoint.hpp>
#include <barchan/core/brick/measure.hpp>
#include <barchan/tasks/cuts.hpp>
#include <barchan/tasks/strip_plan.hpp>
#include <barchan/tasks/strip_seed.hpp>

namespace barchan {
namespace {

constexpr int kRecutEvery = 8;  // rebuilds between looks at the balance

}  // namespace

template <int Dim>
StripRebuild<Dim>::StripRebuild(Strip<Dim>& strip)
    : strip_(strip),
      work_(strip.num_lanes()),
      sizes_(strip.communicator(), 1, 0),
      outboxes_(static_cast<std::size_t>(strip.num_lanes())),
      slab_digests_(static_cast<std::size_t>(strip.num_links())),
      shadow_digests_(slab_digests_.size()),
      outgoing_(static_cast<std::size_t>(strip.num_links())) {
  for (int l = 0; l < strip.num_lanes(); ++l) outboxes(l).resize(strip.ties(l).size());
}

template <int Dim>
void StripRebuild<Dim>::seed(const ParticleSet& set) {
  const Grid<Dim>& grid = strip_.world().grid;
  const std::vector<CellAt<Dim>> cells = cells_of(grid, set);
  CellLoads loads(room_of(grid, 0).cells);
  for (const CellAt<Dim>& cell : cells) loads.add<Dim>(cell);
  cuts_ = equal_cuts(loads, strip_.map().shape());
  std::vector<Placement<Dim>> places;
  places.reserve(static_cast<std::size_t>(strip_.num_lanes()));
  for (int l = 0; l < strip_.num_lanes(); ++l) places.push_back(placement_of(l));
  seed_lanes<Dim>(strip_, set, cells, places);
  begin_lists();
}

template <int Dim>
void StripRebuild<Dim>::restore(Cuts cuts, std::span<const CheckpointShare> shares) {
  cuts_ = std::move(cuts);
  for (int l = 0; l < strip_.num_lanes(); ++l) {
    Lane<Dim>& lane = strip_.lane(l);
    barchan::restore(lane.brick, lane.rebuild, placement_of(l),
                     shares[static_cast<std::size_t>(l)]);
  }
  begin_lists();
}

template <int Dim>
void StripRebuild<Dim>::begin_lists() {
  for (Lane<Dim>& lane : strip_.lanes()) lane.rebuild.order();
  exchange_ghosts([this](const std::function<void(int)>& body) {
    for (int l = 0; l < strip_.num_lanes(); ++l) body(l);
  });
  for (Lane<Dim>& lane : strip_.lanes()) {
    lane.lists.restart_seconds();  // setting up is not part of the loop
    lane.rebuild.carry().imbalance() = {};
  }
}

template <int Dim>
void StripRebuild<Dim>::rebuild(const ForEachLane& parallel) {
  // A halo that is on its way is of no use any more. Where the exchange allows it, it is waited for
  // behind migration.
  const Exchange* exchange = strip_.exchange();
  if (exchange != nullptr && (!exchange->allows_uneven_sides() || strip_.keeps_shadows_level()))
    discard_halo();
  note_slabs();
  ++num_rebuilds_;
  if (num_rebuilds_ % kRecutEvery == 0) recut();
  migrate(parallel);
  exchange_ghosts(parallel);
}

template <int Dim>
void StripRebuild<Dim>::discard_halo() {
  const std::int64_t begin = now_ns();
  count_wait(waits_.halo, Trace::Slice::Wait, begin, strip_.discard_halo());
}

template <int Dim>
void StripRebuild<Dim>::count_wait(double& seconds, Trace::Slice name, std::int64_t begin,
                                   std::int64_t posted) {
  const std::int64_t end = now_ns();
  seconds += to_seconds(end - begin);
  waits_.late +=
      1e-9 * static_cast<double>(std::clamp<std::int64_t>(posted - begin, 0, end - begin));
  if (strip_.trace() != nullptr) strip_.trace()->slice(name, 0, begin, end);
}

template <int Dim>
void StripRebuild<Dim>::recut() {
  const CutShape& shape = strip_.map().shape();
  if (shape.num_ranks() * shape.num_lanes() == 1) return;
  const Grid<Dim>& grid = strip_.world().grid;
  work_.end_window();
  CellLoads loads(room_of(grid, 0).cells);
  for (int l = 0; l < strip_.num_lanes(); ++l) {
    const auto& store = strip_.lane(l).brick.store;
    for (std::int32_t i = 0; i < store.num_owned; ++i)
      loads.add<Dim>(grid.cell(store.x(i)), work_.weight(l));
  }
  const std::int64_t begin = now_ns();
  taped_sum(strip_.communicator(), loads.all());
  count_wait(waits_.migration, Trace::Slice::Reduction, begin, 0);
  move_cuts(cuts_, loads, shape);
}

template <int Dim>
void StripRebuild<Dim>::migrate(const ForEachLane& parallel) {
  parallel([this](int l) { strip_.lane(l).rebuild.begin(placement_of(l), outboxes(l)); });
  begin_bulk();
  if (strip_.exchange() != nullptr) {
    for (const Lane<Dim>& lane : strip_.lanes()) num_migrations_ += lane.rebuild.num_leaving();
  }
  parallel([this](int l) {
    for (const LaneTie& tie : strip_.ties(l)) {
      if (tie.link < 0) strip_.lane(l).rebuild.absorb(bulk(tie));
    }
  });
  if (strip_.exchange() != nullptr) {
    discard_halo();
    wait_bulk("migration", waits_.migration, Trace::Slice::Migration);
    for (int link = 0; link < strip_.num_links(); ++link)
      strip_.lane(strip_.end_of(link).lane).rebuild.absorb(strip_.exchange()->bulk(link));
  }
  parallel([this](int l) {
    strip_.lane(l).rebuild.take_in(newcomers_);
    strip_.lane(l).rebuild.order();
  });
  newcomers_ = {};
}

template <int Dim>
void StripRebuild<Dim>::begin_bulk() {
  bulk_begin_ = now_ns();
  if (strip_.exchange() == nullptr) return;
  for (int link = 0; link < strip_.num_links(); ++link) {
    const auto& end = strip_.end_of(link);
    outgoing_[static_cast<std::size_t>(link)] =
        outboxes(end.lane)[static_cast<std::size_t>(end.tie)];
  }
  strip_.exchange()->begin_bulk(outgoing_);
}

template <int Dim>
std::span<const std::byte> StripRebuild<Dim>::bulk(const LaneTie& tie) {
  if (tie.link >= 0) return strip_.exchange()->bulk(tie.link);
  return outboxes(tie.lane)[static_cast<std::size_t>(tie.back)];
}

template <int Dim>
void StripRebuild<Dim>::note_slabs() {
  if (!strip_.keeps_shadows_level()) return;
  for (int link = 0; link < strip_.num_links(); ++link) {
    const Shadows<Dim>* beyond = strip_.shadows(link);
    if (beyond == nullptr) continue;
    const auto& end = strip_.end_of(link);
    const Brick<Dim>& brick = strip_.lane(end.lane).brick;
    const auto at = static_cast<std::size_t>(link);
    slab_digests_[at].clear();
    shadow_digests_[at].clear();
    if (strip_.are_shadows_stale()) continue;
    for (int n = 0; n < beyond->depth(); ++n)
      slab_digests_[at].push_back(digest(brick, slab_behind(brick, end.side, n)));
    shadow_digests_[at] = beyond->digests();
  }
}

template <int Dim>
void StripRebuild<Dim>::pack_ghosts(int l, int tie) {
  Bytes& message = outboxes(l)[static_cast<std::size_t>(tie)];
  const int link = strip_.ties(l)[static_cast<std::size_t>(tie)].link;
  const Shadows<Dim>* beyond = link < 0 ? nullptr : strip_.shadows(link);
  if (beyond == nullptr) return strip_.lane(l).rebuild.pack_ghosts(tie, message);
  strip_.lane(l).rebuild.pack_slabs(tie, beyond->depth(), message);
  ByteWriter(message).put_counted(slab_digests_[static_cast<std::size_t>(link)]);
}

template <int Dim>
void StripRebuild<Dim>::fill_shadows(int link) {
  Shadows<Dim>* beyond = strip_.shadows(link);
  if (beyond == nullptr) return;
  const auto& end = strip_.end_of(link);
  ByteReader in(strip_.exchange()->bulk(link));
  beyond->fill(strip_.lane(end.lane), end.tie, in);
  const auto theirs = in.take_counted<std::uint64_t>();
  in.finish();
  if (theirs == shadow_digests_[static_cast<std::size_t>(link)]) return;
  throw RunError(fmt::format("rank {}: at step {} shadows of rank {} are not what their owner has",
                             strip_.communicator().rank(), strip_.step,
                             strip_.neighbours().rank(link)));
}

/// For the lists of a lane.
template <int Dim>
std::span<const std::byte> StripRebuild<Dim>::ghosts(const LaneTie& tie) {
  const Shadows<Dim>* beyond = tie.link < 0 ? nullptr : strip_.shadows(tie.link);
  return beyond == nullptr ? bulk(tie) : beyond->ghosts();
}

template <int Dim>
void StripRebuild<Dim>::exchange_ghosts(const ForEachLane& parallel) {
  parallel([this](int l) {
    for (std::size_t tie = 0; tie < outboxes(l).size(); ++tie)
      pack_ghosts(l, static_cast<int>(tie));
  });
  begin_bulk();
  parallel([this](int l) { strip_.lane(l).lists.list_owned(); });  // the messages travel meanwhile
  const bool is_alone = strip_.exchange() == nullptr;
  const bool returns = strip_.scheme() == CutScheme::Returned;
  if (!is_alone && !returns) begin_sizes();
  if (!is_alone) wait_bulk("ghosts", waits_.ghosts, Trace::Slice::Ghosts);
  for (int link = 0; link < strip_.num_links(); ++link) fill_shadows(link);
  parallel([this](int l) {
    Lane<Dim>& lane = strip_.lane(l);
    std::vector<std::span<const std::byte>> messages;
    for (const LaneTie& tie : strip_.ties(l)) messages.push_back(ghosts(tie));
    lane.rebuild.take_ghosts(messages);
    lane.rebuild.restore_history();
    lane.lists.cut_chunks(chunk_pairs);
  });
  strip_.begin_lists();
  if (is_alone) return;
  if (returns) begin_sizes();  // sizes of results follow from the lists
  const std::int64_t begin = now_ns();
  sizes_.wait();
  count_wait(waits_.ghosts, Trace::Slice::Reduction, begin, 0);
  strip_.exchange()->reserve(static_cast<std::size_t>(sizes_.maxima()[0]));
}

template <int Dim>
void StripRebuild<Dim>::begin_sizes() {
  const double most = static_cast<double>(strip_.most_halo_bytes());
  sizes_.begin(std::span(&most, 1), {});
}

template <int Dim>
void StripRebuild<Dim>::wait_bulk(const char* what, double& seconds, Trace::Slice name) {
  const std::int64_t begin = now_ns();
  wait_until(
      [this] {
        if (sizes_.is_in_flight()) (void)sizes_.test();
        return strip_.exchange()->poll_bulk();
      },
      [this, what] {
        std::string from;
        for (int link = 0; link < strip_.num_links(); ++link)
          from += fmt::format("{} rank {}", from.empty() ? "from" : " or",
                              strip_.neighbours().rank(link));
        return fmt::format("rank {}: {} of step {} {}", strip_.communicator().rank(), what,
                           strip_.step, from);
      });
  waits_.in_flight += seconds_since(bulk_begin_);
  std::int64_t posted = 0;
  for (int link = 0; link < strip_.num_links(); ++link) {
    if (strip_.shares_clock(link)) posted = std::max(posted, strip_.exchange()->bulk_posted(link));
  }
  count_wait(seconds, name, begin, posted);
}

template class StripRebuild<2>;
template class StripRebuild<3>;

}  // namespace barchan
