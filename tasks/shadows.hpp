#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include <barchan/core/brick/lane.hpp>

namespace barchan {

/// The shadows beyond one cut between ranks: slabs of the neighbour's lane that are copied at each
/// rebuild and stepped here as well, so that its halo may come `depth` steps late.
///
///     own lane │ 1 │ 2 │ … │ depth │ ghosts, by messages        the number of a node: own is 0
///
/// Each node tells both beside it where its particles are, and takes step k when both have told of
/// step k: so none is more than a step ahead of the next one, and two frames for each way are
/// enough. The own lane waits for shadow 1, and shadow `depth` for the message of step k, which is
/// that of the owner's slab behind the shadows. So validity shrinks by a slab a step without
/// messages, and each message moves it on:
///
///     own is in step t  ⇒  shadow n has done step t − n  ⇒  message t − depth is in
///
/// A shadow computes what its owner computes, from the same operands: sums have no order
/// (force_grain.hpp). It has no part in totals, digests, checks and results. What changes between
/// steps without lists made anew is kept for each step until all shadows have done it: the frame,
/// walls and lengths of steps.
///
/// One thread at a time.
template <int Dim>
class Shadows {
 public:
  /// @param side  of the own lane, where the cut is. @param world  of the run
  Shadows(const World<Dim>& world, Side side, int depth);

  [[nodiscard]] int depth() const { return static_cast<int>(slices_.size()); }

  // ---- at a rebuild
  /// Copies anew from what the owner packed (Rebuild::pack_slabs).
  /// @param own  ordered, its cells known. @param link  of it, to the owner
  void fill(const Lane<Dim>& own, int link, ByteReader& message);
  /// Of shadow 1, for the own lane: as Rebuild::pack_ghosts. @pre fill
  [[nodiscard]] std::span<const std::byte> ghosts() const { return ghosts_[0]; }
  /// By shadow, the sum of its particles' hashes. @pre catch_up
  [[nodiscard]] std::vector<std::uint64_t> digests() const;

  // ---- the step
  /// The own lane begins a step.
  void begin_step(const StepFrame& frame);
  [[nodiscard]] std::int64_t steps() const { return told_[0]; }  ///< of the own lane
  /// Whether the next message has room here.
  [[nodiscard]] bool wants_message() const { return told_.back() <= told_[told_.size() - 2]; }
  void take_message(std::span<const std::byte> message);
  /// Instead: nobody will need it.
  void drop_message() { ++told_.back(); }
  /// Steps of this rank whose halo was sent, and that of the neighbour has not come.
  [[nodiscard]] bool awaits_message() const { return told_.back() < told_.front(); }
  [[nodiscard]] std::int64_t messages_in() const { return told_.back(); }  ///< since the rebuild
  /// Takes the steps that are possible. @return whether there were any
  bool advance();
  /// Whether the own lane's ghosts for its step are known.
  [[nodiscard]] bool is_in() const { return told_[1] >= told_[0]; }
  /// All shadows have come to the own lane's step.
  [[nodiscard]] bool is_level() const { return told_[told_.size() - 2] == told_[0] && is_in(); }
  /// @pre is_in
  [[nodiscard]] std::span<const std::byte> halo() const { return frame_to_inside(1, told_[0]); }
  /// The own lane's cut is finished. @param link  as in fill
  void tell(const Brick<Dim>& own, int link);

  [[nodiscard]] std::int64_t work_ns() const { return work_ns_; }  ///< in their steps
  [[nodiscard]] std::size_t bytes() const;

 private:
  using Bytes = std::vector<std::byte>;
  /// Without what no step depends on: accounts, and fields of the caller's own.
  [[nodiscard]] static World<Dim> bare(World<Dim> world) {
    world.accounts = false;
    world.num_carried = 0;
    return world;
  }
  struct Slice {
    World<Dim> world;  ///< as it was at the step that the slice is in
    Lane<Dim> lane{world};
    explicit Slice(const World<Dim>& of) : world(bare(of)) {}
  };
  struct Record {  ///< of a step of the own lane
    StepFrame frame;
    std::vector<WallState> walls;
    double dt = 0.0, last_dt = 0.0;
  };
  /// What a node told one beside it, by parity of the step that it is for.
  using Frames = std::array<Bytes, 2>;

  [[nodiscard]] Slice& slice(int n) { return slices_[static_cast<std::size_t>(n) - 1]; }
  [[nodiscard]] std::int64_t& told(int n) { return told_[static_cast<std::size_t>(n)]; }
  [[nodiscard]] const Bytes& frame_to_inside(int from, std::int64_t step) const {
    return to_inside_[static_cast<std::size_t>(from)][static_cast<std::size_t>(step % 2)];
  }
  [[nodiscard]] int inner_link() const { return side_ == Side::Right ? 0 : 1; }
  [[nodiscard]] int outer_link() const { return 1 - inner_link(); }
  [[nodiscard]] Placement<Dim> placement(const Lane<Dim>& own, int link, int n) const;
  [[nodiscard]] bool may_step(int n);
  void step(int n);
  void press_plates(Slice& of, const StepFrame& frame);
  static void pack(const Brick<Dim>& brick, int link, Bytes& frame);

  const World<Dim>& world_;
  Side side_;
  std::deque<Slice> slices_;
  std::vector<std::int64_t> told_;  ///< by node: the step that it told of last; from the rebuild
  std::vector<Frames> to_inside_, to_outside_;  ///< by node
  std::vector<Bytes> ghosts_;                   ///< of a rebuild, by shadow, to the one inside
  std::vector<Record> records_;                 ///< a ring
  std::int64_t begun_ = 0;                      ///< steps of the own lane since the rebuild
  std::vector<WallSums> pressed_;               ///< by shadows on plates; nobody's
  std::int64_t work_ns_ = 0;
};

extern template class Shadows<2>;
extern template class Shadows<3>;

}  // namespace barchan
