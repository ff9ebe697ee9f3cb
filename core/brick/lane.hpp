#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <barchan/core/brick/departure.hpp>
#include <barchan/core/brick/lane_messages.hpp>
#include <barchan/core/brick/measures.hpp>
#include <barchan/core/brick/passage.hpp>
#include <barchan/core/brick/world.hpp>
#include <barchan/core/kernels/history_table.hpp>
#include <barchan/core/links/bonds.hpp>
#include <barchan/core/links/walls.hpp>
#include <barchan/core/particles/particle_store.hpp>
#include <barchan/core/search/band.hpp>
#include <barchan/core/search/contact_search.hpp>
#include <barchan/core/search/pair_list.hpp>

namespace barchan {

struct CheckpointShare;

/// A lane is to a thread what a strip is to a rank: slabs [slab_begin, slab_end) with their
/// particles, pairs and bonds, and ghosts of the slabs next to it. All functions are
/// single-threaded and touch this lane only.
///
/// The steady step (`E precedes F` means E happens before F):
///
///   press_plates       precedes run_chunk(0), where there are loaded plates
///   run_chunk(c)       precedes run_chunk(c + 1)
///   run_chunk(0)       precedes finish_band(Left)
///   the last chunk     precedes finish_band(Right)
///   unpack_halo(side)  precedes finish_band(side)
///   finish_band(side)  precedes pack_halo(side) of the next step
///
/// Forces of pairs are rounded to the grain, so that sums have no order (force_grain.hpp). Rows
/// away from the cuts are advanced in place, chunk by chunk; those of a band when the pairs with
/// its ghosts are in.
template <int Dim>
class Lane {
 public:
  using Store = ParticleStore<Dim>;
  using L = Layout<Dim>;

  explicit Lane(World<Dim>& world) : world_(&world) {}

  // ---- the step (lane_step.cpp)
  /// Contacts with loaded plates, before the step's other forces: their forces on the plates are
  /// added to `sums`, one a wall. Needs owned rows only.
  void press_plates(const StepFrame& frame, std::span<WallSums> sums);
  void begin_step(const StepFrame& frame);
  [[nodiscard]] int num_chunks() const { return static_cast<int>(chunks_.size()) - 1; }
  void run_chunk(int chunk);
  void unpack_halo(Side side, std::span<const std::byte> message);
  void finish_band(Side side);
  [[nodiscard]] std::size_t halo_bytes(Side side) const;
  void pack_halo(Side side, std::span<std::byte> message) const;
  // The published scheme (lane_results.cpp): the lane right of a cut computes, the other one takes
  // the results.
  /// Of a results message until the next rebuild.
  [[nodiscard]] std::size_t results_bytes(Side side) const;
  /// Forces of the left cut's pairs on its ghosts, and of its bonds, after finish_band(Left).
  void results(std::vector<double>& out);
  /// Instead of finish_band(Right). @param results  what results() gave on the other side
  void finish_right_band(std::span<const double> results);

  // ---- particles that left the domain (lane_watch.cpp), between steps
  /// Owned particles out of the domain.
  [[nodiscard]] std::vector<Departure> outside(std::int64_t step) const;
  /// These particles, of any lane, go in the begin_rebuild that follows, with their contacts and
  /// bonds. @param ids  ascending. @return how many of those this lane counts
  LinkCounts remove(std::span<const std::int64_t> ids);

  // ---- what a run that goes wrong says (lane_watch.cpp), between steps
  /// A particle moved farther than World::most_travel() in the last step, or is not finite.
  [[nodiscard]] bool is_fast() const { return is_beyond_; }
  /// Two that passed each other in the step before the last one; of several the first.
  [[nodiscard]] const Passage& passage() const { return passage_; }
  /// Of a particle the contact forces in the last step, by size, where they were more than can be
  /// summed exactly [N]; else zero.
  [[nodiscard]] double overload() const {
    return speeds_.top_force > world_->grain.most() ? speeds_.top_force : 0.0;
  }
  /// The last step went wrong in one of these ways.
  [[nodiscard]] bool must_stop() const {
    return is_fast() || passage_.exists() || overload() > 0.0;
  }
  /// Of those that did the one with the lowest id. @pre is_fast()
  [[nodiscard]] std::int32_t first_fast_row() const;
  /// The fastest one; one that is not finite before all others. -1: there is none
  [[nodiscard]] std::int32_t fastest_row() const;
  [[nodiscard]] Suspect suspect(std::int32_t row) const;
  /// Ids of owned particles that touch another one, of any lane.
  void find_touching(const Suspect& other, std::vector<std::int64_t>& ids) const;
  /// What a row touched as the last step began. Of one that is not finite now nobody knows where it
  /// was: all that was near it when lists were built. The published scheme knows ghosts on the
  /// right as they were then.
  struct Partners {
    std::vector<std::int64_t> ids;    ///< ascending
    std::vector<std::int32_t> walls;  ///< ascending
  };
  [[nodiscard]] Partners partners_before_step(std::int32_t row) const;
  [[nodiscard]] WorstOverlap worst_overlap() const;

  // ---- the rebuild (lane_rebuild.cpp), in this order
  /// Instead of begin_rebuild at the start of a run: owns these particles and bonds.
  /// @pre they lie in the slabs
  void seed(int slab_begin, int slab_end, std::span<const ParticleData> particles,
            std::span<const BondData> bonds, std::span<const double> bond_lengths,
            std::span<const char> is_bonded);
  /// Takes slabs [slab_begin, slab_end) from now on; writes who leaves, with history and bonds.
  void begin_rebuild(int slab_begin, int slab_end, std::vector<std::byte>& to_left,
                     std::vector<std::byte>& to_right);
  void absorb(std::span<const std::byte> message);  ///< arrivals
  void order();                                     ///< by cells
  void pack_ghosts(Side side, std::vector<std::byte>& message) const;
  void list_owned();
  void take_ghosts(std::span<const std::byte> left, std::span<const std::byte> right);
  void restore_history();
  /// @param chunk_pairs  pairs per chunk of the step; any number gives the same bits
  void cut_chunks(std::int64_t chunk_pairs);

  // ---- checkpoints (lane_checkpoint.cpp)
  /// Everything that the next step depends on, between steps. Reuses the memory of `share`.
  /// @pre ghosts are up to date
  void save(CheckpointShare& share);
  /// Instead of seed: owns the particles of a checked share, and queues the history of contacts,
  /// walls and bonds that have an end among them. order() … restore_history() follow.
  /// @pre they lie in the slabs. Errors: RunError for an id that comes twice
  void restore(int slab_begin, int slab_end, const CheckpointShare& share);

  // ---- between steps, ghosts up to date (lane_measure.cpp)
  [[nodiscard]] Measures measure(const Vec3& gravity);
  [[nodiscard]] Travel travel() const;  ///< since the last rebuild; needs no ghosts
  /// The largest id of an owned particle out of the domain; 0: none is.
  [[nodiscard]] std::int64_t last_outside() const;
  /// Lists before these were used with a wall that had moved so far since they were built; the next
  /// travel() tells when that was too far. @param share  see outrun_share. After a rebuild.
  void note_outrun(double share) { outrun_ = std::max(outrun_, share); }
  [[nodiscard]] std::uint64_t digest() const;
  /// Is the bond whole, and is this the one lane of two that counts it?
  [[nodiscard]] bool counts_bond(std::int32_t bond) const;

  // ---- what others see
  Store& store() { return store_; }
  [[nodiscard]] const Store& store() const { return store_; }
  BondSet<Dim>& bonds() { return bonds_; }
  [[nodiscard]] const BondSet<Dim>& bonds() const { return bonds_; }
  WallContacts<Dim>& wall_contacts() { return walls_; }
  [[nodiscard]] const WallContacts<Dim>& wall_contacts() const { return walls_; }
  /// Of all walls the work since the start.
  std::vector<WallSums>& wall_sums() { return wall_sums_; }
  [[nodiscard]] std::vector<WallSums> measure_walls() const;
  Band& band(Side side) { return bands_[index_of(side)]; }
  [[nodiscard]] const Band& band(Side side) const { return bands_[index_of(side)]; }
  /// Pairs and history; packed history is put back in its place first (unpack_history).
  PairList& pairs() {
    unpack_history();
    return pairs_;
  }
  /// Brings the history of touching pairs back to their candidates' places. Cheap when nothing is
  /// packed.
  void unpack_history();
  void unpack_history_across(Side side);
  [[nodiscard]] std::int64_t num_leaving() const {
    return std::count_if(goes_.begin(), goes_.end(), [](auto g) { return g == 1 || g == 2; });
  }
  /// What rebuilds have found too much or too little, since the start: links after them less links
  /// before them. Summed over all lanes it is zero, or something was lost.
  [[nodiscard]] const LinkCounts& imbalance() const { return imbalance_; }
  void lose(Loss what) { loss_ = what; }        ///< tests: one of these, in the next rebuild
  void forget_imbalance() { imbalance_ = {}; }  ///< the links of the start came from elsewhere
  [[nodiscard]] int slab_begin() const { return slab_begin_; }
  [[nodiscard]] int slab_end() const { return slab_end_; }
  [[nodiscard]] std::int64_t num_pairs() const;
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] const SearchSeconds& search_seconds() const { return search_seconds_; }
  void restart_search_seconds() { search_seconds_ = {}; }
  World<Dim>& world() { return *world_; }
  [[nodiscard]] const World<Dim>& world() const { return *world_; }

 private:
  struct Block : PairBlock {
    std::array<Rows, 2> to_come;  ///< rows to ask for (lane_prefetch.cpp)
    std::int32_t final_row = 0;   ///< rows before this one are complete after the block
    bool has_extras = false;      ///< bonds, walls or external forces among them
  };

  void queue_links(const CheckpointShare& share,
                   const std::unordered_map<std::int64_t, std::int32_t>& row_of);
  /// Largest squared displacement since the last rebuild that a step was computed with: before its
  /// drift.
  [[nodiscard]] double distance2_of_last_step() const;
  /// 0 here, 1 left, 2 right
  [[nodiscard]] int direction_of(std::int64_t key, std::int64_t key_before) const;
  static constexpr std::int8_t kGone = 3;  ///< as a direction: out of the domain
  [[nodiscard]] bool is_removed(std::int32_t row) const {
    return !removed_.empty() && std::binary_search(removed_.begin(), removed_.end(),
                                                   store_.id[static_cast<std::size_t>(row)]);
  }
  /// Whether to lose one of these now.
  bool loses(Loss what) { return loss_ == what && std::exchange(loss_, Loss::Nothing) == what; }
  [[nodiscard]] bool computes_bond(std::int32_t bond) const;
  [[nodiscard]] std::pair<bool, bool> bond_leaves(std::int32_t bond) const;
  PairJob job(PairList& list) const;
  void run_block(Block& block);
  void run_with_prefetch(const Block& block, const PairJob& pairs) const;
  void prefetch(Rows rows) const;
  /// The pairs of a block that are worked on.
  [[nodiscard]] PairJob block_job(PairList& list, PairBlock& block, double travel);
  void pick_touching(PairList& list, PairBlock& block, PairJob& pairs, double travel);
  [[nodiscard]] double packing_margin() const;  ///< [m]
  /// Of a component of velocity, beyond which step_travel() is looked at [m/s].
  [[nodiscard]] double quick_speed() const {
    return world_->quick_travel / (std::sqrt(double{Dim}) * world_->dt);
  }
  [[nodiscard]] bool is_beyond(double travel) const {
    return !(travel <= world_->most_travel(lists_skin_));
  }
  void judge_speeds(Rows rows);
  void find_quick();
  void pack(PairList& list, PairBlock& block, const std::uint8_t* masks);
  [[nodiscard]] bool packs() const {
    return world_->kernels.narrow != nullptr && world_->search == ContactSearchKind::Cells;
  }
  void finish_rows(std::int32_t begin, std::int32_t end, bool has_extras);
  void wrap_rows(Rows rows);
  [[nodiscard]] typename WallContacts<Dim>::Frame wall_frame(double dt) const {
    return {world_->wall_view(), &world_->laws, dt};
  }
  void compute_bonds(typename BondSet<Dim>::Group group);
  void unbind(std::int32_t bond);
  void research_owned();
  void research_across(Side side);

  void cut_blocks();
  void plan_prefetch();
  [[nodiscard]] SearchRule search_rule() const;
  void find_owned();
  void list_across(Side side);
  void list_bonded();
  struct Slot {
    PairList* list = nullptr;
    std::int64_t k = -1;
  };
  Slot slot(std::int32_t a, std::int32_t b);
  Slot owned_slot(std::int32_t low, std::int32_t high);
  Slot find_pair(PairList& list, std::pair<std::int32_t, std::int32_t> wanted) const;
  std::int32_t find_near(std::int32_t row, std::int64_t id) const;
  bool place(std::int32_t a, std::int32_t b, const double* history_a_to_b);
  void restore_wall_history();
  void put(const Slot& at, bool is_swapped, const double* history) const;
  /// @param number  of every row that leaves, its place among the leavers
  void collect_history(std::array<Migration<Dim>, 2>& leaving,
                       std::span<const std::int32_t> number);
  void keep_staying(const PairBlock& block, std::array<Migration<Dim>, 2>& leaving,
                    std::span<const std::int32_t> number);
  void loosen(const PairList& list, std::int64_t k, std::array<std::int32_t, 2> ends, bool counts,
              std::array<Migration<Dim>, 2>& leaving, std::span<const std::int32_t> number);

  World<Dim>* world_;
  StepFrame frame_;
  bool wraps_now_ = false;  ///< after this step
  Store store_;
  PairList pairs_;  ///< of two owned particles
  std::array<Band, 2> bands_;
  BondSet<Dim> bonds_;
  BondedPairs bonded_;
  WallContacts<Dim> walls_;
  std::vector<WallContact<Dim>> old_walls_;
  std::vector<WallSums> wall_sums_;
  CellIndex cells_;
  Planes planes_;
  std::vector<std::int64_t> row_begin_;
  std::vector<Block> blocks_;
  bool prefetches_ = false;
  std::vector<int> chunks_{0};  ///< first block of each chunk, and the end
  std::int32_t rows_done_ = 0;
  std::int64_t steps_since_start_ = 0;
  SearchSeconds search_seconds_;
  int slab_begin_ = 0, slab_end_ = 0;
  double lists_skin_ = 0.0;  ///< [m]
  double outrun_ = 0.0;      ///< of the last step with the lists before these, see outrun_share
  RowSpeeds speeds_;         ///< of the rows of this step
  bool is_beyond_ = false;   ///< see is_fast()
  bool has_quick_ = false;   ///< an owned row moved farther than World::quick_travel
  bool looks_ = false;       ///< for passages, in this step
  Passage passage_;
  double step_travel_ = 0.0, travel_ = 0.0;  ///< bounds: of the last step, since the lists were cut

  [[nodiscard]] const History& history_form() const {
    return world_->laws.law().template in<Dim>().history;
  }
  /// Contacts while lists are made anew, by the rows that they had before.
  using KeptContacts = HistoryTable<std::array<std::int32_t, 2>>;
  KeptContacts kept_;

  template <class Length>
  static void keep(KeptContacts& to, std::size_t at, const PairList& list, std::int64_t k,
                   Length length) {
    double* numbers = to.numbers.data() + at * static_cast<std::size_t>(length);
    const double* from = list.history.data() + k / kBatch * kBatch * length + k % kBatch;
    for (int c = 0; c < length; ++c) numbers[c] = from[c * kBatch];
  }
  static void keep_histories(const PairList& list, KeptContacts& to);
  /// Of pairs that are in both.
  void put_histories(PairList& list, const KeptContacts& kept) const;

  // between begin_rebuild and restore_history
  std::vector<std::int32_t> new_row_;  ///< of every source row; -1: left
  std::vector<std::int8_t> goes_;      ///< of every source row: 0 stays, 1 left, 2 right, kGone
  HistoryTable<LooseContact> loose_;

  std::vector<std::int64_t> removed_;  ///< ids that go in the next rebuild, ascending
  LinkCounts imbalance_;
  Loss loss_ = Loss::Nothing;
};

extern template class Lane<2>;
extern template class Lane<3>;

}  // namespace barchan
