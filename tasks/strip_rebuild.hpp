#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <barchan/comm/base/reduction.hpp>
#include <barchan/core/particles/share.hpp>
#include <barchan/tasks/strip.hpp>
#include <barchan/tasks/work_meter.hpp>

namespace barchan {

/// Seconds that a rank waited in its rebuilds with nothing else to do, since the lists were first
/// built.
struct RebuildWaits {
  double halo = 0.0;       ///< for a halo that the rebuild made useless
  double migration = 0.0;  ///< for migrants, and for counts when cuts move
  double ghosts = 0.0;     ///< for ghosts, and for the size of halos to come
  double in_flight = 0.0;  ///< migrants and ghosts, from the send until they were in
  double late = 0.0;       ///< of all: until a neighbour on this node had sent
  [[nodiscard]] double sum() const { return halo + migration + ghosts; }
};

/// Makes the lists of a strip, first and anew: which particles are its own, where cuts lie, and
/// what passes between lanes and ranks for it.
///
///     migrants ─► order by cells ─► ghosts ─► lists, history
///
/// Lanes of a rank find in each other's outboxes what ranks send each other.
template <int Dim>
class StripRebuild {
 public:
  /// Runs a function for every lane, on as many threads as there are.
  using ForEachLane = std::function<void(const std::function<void(int)>&)>;

  /// @param strip  lives longer
  explicit StripRebuild(Strip<Dim>& strip);

  /// Cuts the domain for equal counts, keeps this rank's share, and builds all lists. Collective.
  void seed(const ParticleSet& set);
  /// Instead of seed: the state of a checkpoint, between steps. Collective.
  /// @param shares  one for each lane of this rank: particles between its cuts, and all that has an
  /// end among them
  void restore(Cuts cuts, std::span<const CheckpointShare> shares);
  /// The next rebuild takes them in; the same on every rank, and they live until then.
  void take_in(std::span<const ParticleData> newcomers) { newcomers_ = newcomers; }
  /// Collective; leaves ghosts up to date.
  void rebuild(const ForEachLane& parallel);

  [[nodiscard]] const Cuts& cuts() const { return cuts_; }
  void set_cuts(const Cuts& cuts) { cuts_ = cuts; }  ///< with bricks that fit them
  [[nodiscard]] const RebuildWaits& waits() const { return waits_; }
  void restart_waits() { waits_ = {}; }  ///< setting up is not part of the loop
  [[nodiscard]] std::int64_t num_rebuilds() const { return num_rebuilds_; }
  /// Particles that left this rank.
  [[nodiscard]] std::int64_t num_migrations() const { return num_migrations_; }
  [[nodiscard]] WorkMeter& work() { return work_; }  ///< by which cuts move
  std::int64_t chunk_pairs = 1 << 14;                ///< pairs per chunk from the next rebuild on

 private:
  using Bytes = std::vector<std::byte>;

  void discard_halo();
  void recut();
  void migrate(const ForEachLane& parallel);
  void exchange_ghosts(const ForEachLane& parallel);
  /// Before there are threads.
  void begin_lists();
  [[nodiscard]] std::vector<Bytes>& outboxes(int l) {
    return outboxes_[static_cast<std::size_t>(l)];
  }
  /// Sends the outboxes of links. bulk() gives what came, from a rank or a lane.
  void begin_bulk();
  [[nodiscard]] std::span<const std::byte> bulk(const LaneTie& tie);
  /// Sums of hashes of the slabs that are somebody's shadows.
  void note_slabs();
  void pack_ghosts(int l, int tie);
  void fill_shadows(int link);
  [[nodiscard]] std::span<const std::byte> ghosts(const LaneTie& tie);
  [[nodiscard]] Placement<Dim> placement_of(int l) const {
    return placement<Dim>(strip_.map(), cuts_, strip_.communicator().rank(), l, strip_.ties(l));
  }
  void wait_bulk(const char* what, double& seconds, Trace::Slice name);
  void begin_sizes();
  /// Since `begin`, for what a neighbour sent at `posted`; 0: not known
  void count_wait(double& seconds, Trace::Slice name, std::int64_t begin, std::int64_t posted);

  Strip<Dim>& strip_;
  WorkMeter work_;
  Reduction sizes_;                           ///< of halos to come
  std::vector<std::vector<Bytes>> outboxes_;  ///< by lane and tie
  /// By link and slab; empty where nobody compares, or nothing is there yet.
  std::vector<std::vector<std::uint64_t>> slab_digests_, shadow_digests_;
  std::vector<std::span<const std::byte>> outgoing_;  ///< by link
  Cuts cuts_;
  std::span<const ParticleData> newcomers_;
  RebuildWaits waits_;
  std::int64_t bulk_begin_ = 0;
  std::int64_t num_rebuilds_ = 0, num_migrations_ = 0;
};

extern template class StripRebuild<2>;
extern template class StripRebuild<3>;

}  // namespace barchan
