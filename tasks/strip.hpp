#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/comm/slots/exchange.hpp>
#include <barchan/core/brick/lane.hpp>
#include <barchan/tasks/cut_scheme.hpp>
#include <barchan/tasks/trace.hpp>

namespace barchan {

/// The strip of one rank: its lanes, one per thread, and the halos that pass between lanes and
/// between ranks in a step. What passes when lists are made anew is the business of StripRebuild.
///
///   ranks    |        0        |        1        |
///   lanes    |   0    |   1    |   2    |   3    |
///
/// Cuts lie on slab faces. With T threads a rank, every T-th of them is between ranks.
/// A cut between two lanes of one rank works like one between ranks, with an outbox in memory for a
/// message: a lane writes the outbox of step k + 1 when its band is finished in step k. Outboxes
/// come in pairs, so that the neighbour may still read the one of step k.
template <int Dim>
class Strip {
 public:
  Strip(World<Dim>& world, const Communicator& communicator, std::unique_ptr<Exchange> exchange,
        int num_lanes, CutScheme scheme);

  // ---- lanes and who is beside them; side is one of a lane's two
  [[nodiscard]] int num_lanes() const { return static_cast<int>(lanes_.size()); }
  std::deque<Lane<Dim>>& lanes() { return lanes_; }
  [[nodiscard]] const std::deque<Lane<Dim>>& lanes() const { return lanes_; }
  Lane<Dim>& lane(int l) { return lanes_[static_cast<std::size_t>(l)]; }
  [[nodiscard]] const Lane<Dim>& lane(int l) const { return lanes_[static_cast<std::size_t>(l)]; }
  Lane<Dim>& outer_lane(Side side) { return side == Side::Left ? lanes_.front() : lanes_.back(); }
  [[nodiscard]] bool is_outer(int l, Side side) const {
    return side == Side::Left ? l == 0 : l + 1 == num_lanes();
  }
  /// Whether what lies beyond this side of a lane is another rank's.
  [[nodiscard]] bool is_remote(int l, Side side) const {
    return is_outer(l, side) && neighbours_.has(side);
  }
  /// Whether there is a cut on this side of a lane.
  [[nodiscard]] bool has_neighbour(int l, Side side) const;
  /// The lane of this rank beside this one. Around the end of a periodic axis it may be itself.
  [[nodiscard]] int lane_beside(int l, Side side) const {
    return (l + (side == Side::Left ? num_lanes() - 1 : 1)) % num_lanes();
  }
  [[nodiscard]] const Neighbours& neighbours() const { return neighbours_; }
  [[nodiscard]] CutScheme scheme() const { return scheme_; }
  [[nodiscard]] World<Dim>& world() const { return world_; }
  [[nodiscard]] const Communicator& communicator() const { return communicator_; }

  // ---- the step
  /// Whether this band must wait for a message of another rank in this step.
  [[nodiscard]] bool awaits(Side side) const { return awaited_[index_of(side)]; }
  [[nodiscard]] bool poll(Side side) { return exchange_->poll(side); }
  /// When the neighbour sent the message that is in [ns]; 0: not known, its clock is another one.
  [[nodiscard]] std::int64_t posted_at(Side side) const {
    return shares_clock(side) ? exchange_->halo_times(side).posted : 0;
  }
  /// With the neighbour, on whose node this rank is.
  [[nodiscard]] bool shares_clock(Side side) const { return shares_clock_[index_of(side)]; }
  /// Ghosts in, pairs, rows: everything that a band needs, once its message is there.
  void finish_band(int l, Side side);
  /// Publishes the finished band for the next step. @pre finish_band
  void send_band(int l, Side side);
  /// After all bands of a lane. Lanes of a rank without neighbours may be in different steps.
  void end_step(int l);
  /// After all bands of all lanes: the next step's messages are expected.
  void end_step();
  /// Waits for the messages of this step and unpacks them, without computing; for measurements
  /// between steps.
  void complete_halo();
  /// What this rank waits for, as messages say it: "rank 0: halo of step 17 from rank 1 (right)".
  [[nodiscard]] std::string name_of_halo(Side side) const;

  // ---- lists made anew
  /// Waits for halos on their way and drops them. @return when the last was sent [ns]; 0: not known
  std::int64_t discard_halo();
  /// Ghosts and lists are new: the next step needs no halo, and halos have these sizes.
  void begin_lists();
  [[nodiscard]] std::size_t most_halo_bytes() const;  ///< of a message to a neighbour

  [[nodiscard]] Exchange* exchange() const { return exchange_.get(); }  ///< null: no neighbours
  /// Continues with another exchange. Between new lists and the next step. Collective.
  void set_exchange(std::unique_ptr<Exchange> exchange);
  /// In the exchange, sending halos.
  [[nodiscard]] std::int64_t send_ns() const { return send_ns_; }
  void set_trace(Trace* trace) { trace_ = trace; }
  [[nodiscard]] Trace* trace() const { return trace_; }
  [[nodiscard]] std::int64_t num_owned() const;
  /// Where this rank's particles lie along the strip axis, least and most [m]; zeros without any.
  [[nodiscard]] std::pair<double, double> extent() const;
  [[nodiscard]] std::size_t bytes() const;
  std::int64_t step = 0;  ///< for messages

 private:
  using Bytes = std::vector<std::byte>;
  struct Post {                                ///< messages of one lane
    std::array<std::array<Bytes, 2>, 2> halo;  ///< by parity of the step that needs it, and side
    int parity = 0;                            ///< of the step that the lane is in
    bool is_fresh = true;  ///< ghosts are up to date: nothing to unpack in this step
  };

  [[nodiscard]] Post& post(int l) { return posts_[static_cast<std::size_t>(l)]; }
  [[nodiscard]] const Post& post(int l) const { return posts_[static_cast<std::size_t>(l)]; }
  void set_fresh() {
    for (Post& p : posts_) p.is_fresh = true;
  }
  [[nodiscard]] bool returns() const { return scheme_ == CutScheme::Returned; }
  void place_bands();
  void wait_halo(Side side);
  /// Of ghosts, which in the published scheme come from the left only.
  [[nodiscard]] bool awaits_ghosts(Side side) const {
    return awaits(side) && !(returns() && side == Side::Right);
  }
  [[nodiscard]] std::size_t most_results_bytes() const;  ///< of forces in the published scheme
  /// What the lane beside wrote of its band, for the step at hand. @pre has_neighbour, !is_remote
  [[nodiscard]] const Bytes& inbox(int l, Side side) const;
  template <class Pack>
  void send_halo(Side side, std::size_t bytes, Pack&& pack);

  World<Dim>& world_;
  const Communicator& communicator_;
  std::unique_ptr<Exchange> exchange_;
  Neighbours neighbours_;
  CutScheme scheme_;
  std::deque<Lane<Dim>> lanes_;
  std::vector<Post> posts_;
  std::vector<double> results_;  ///< of the published scheme, going or come
  std::array<bool, 2> shares_clock_{};
  std::array<bool, 2> awaited_{};  ///< a message of another rank is due in this step
  std::int64_t halo_step_ = 0;     ///< that the halo on its way is for
  std::int64_t send_ns_ = 0;
  Trace* trace_ = nullptr;
};

extern template class Strip<2>;
extern template class Strip<3>;

}  // namespace barchan
