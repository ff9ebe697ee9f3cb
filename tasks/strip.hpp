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
#include <barchan/tasks/lane_map.hpp>
#include <barchan/tasks/shadows.hpp>
#include <barchan/tasks/trace.hpp>

namespace barchan {

/// What one rank owns: its lanes, one per thread, and the halos that pass between lanes and between
/// ranks in a step. What passes when lists are made anew is the business of StripRebuild.
///
///   ranks    |        0        |        1        |
///   lanes    |   0    |   1    |   2    |   3    |      and along other axes (LaneMap)
///
/// Cuts lie on faces of cells. A cut between two lanes of one rank works like one between ranks,
/// with an outbox in memory for a message: a lane writes the outbox of step k + 1 when what is
/// beside the cut is finished in step k. Outboxes come in pairs, so that the neighbour may still
/// read the one of step k.
///
/// With a depth (CutShape) each link has shadows of the lane beyond it, which stand between the
/// lane here and its messages: these come from farther behind the cut, and may be late.
template <int Dim>
class Strip {
 public:
  /// @param exchange  null on one rank. @param ties  of this rank (LaneMap)
  Strip(World<Dim>& world, const Communicator& communicator, std::unique_ptr<Exchange> exchange,
        const LaneMap& map, CutScheme scheme);

  // ---- lanes and what is beside them
  [[nodiscard]] int num_lanes() const { return static_cast<int>(lanes_.size()); }
  std::deque<Lane<Dim>>& lanes() { return lanes_; }
  [[nodiscard]] const std::deque<Lane<Dim>>& lanes() const { return lanes_; }
  Lane<Dim>& lane(int l) { return lanes_[static_cast<std::size_t>(l)]; }
  [[nodiscard]] const Lane<Dim>& lane(int l) const { return lanes_[static_cast<std::size_t>(l)]; }
  [[nodiscard]] const LaneMap& map() const { return map_; }
  [[nodiscard]] CutForm form() const { return map_.shape().form; }
  [[nodiscard]] const std::vector<std::vector<LaneTie>>& ties() const { return ties_; }
  [[nodiscard]] const std::vector<LaneTie>& ties(int l) const {
    return ties_[static_cast<std::size_t>(l)];
  }
  /// The lane at this end of a link, its tie, and the band that waits for it.
  struct LinkEnd {
    int lane = 0, tie = 0;
    Side side = Side::Left;
  };
  [[nodiscard]] int num_links() const { return static_cast<int>(ends_.size()); }
  [[nodiscard]] const LinkEnd& end_of(int link) const {
    return ends_[static_cast<std::size_t>(link)];
  }
  [[nodiscard]] bool has_left_link() const;
  [[nodiscard]] const Neighbours& neighbours() const { return neighbours_; }
  [[nodiscard]] CutScheme scheme() const { return scheme_; }
  [[nodiscard]] World<Dim>& world() const { return world_; }
  [[nodiscard]] const Communicator& communicator() const { return communicator_; }

  // ---- the step
  /// Whether a message of another rank is due in this step.
  [[nodiscard]] bool awaits(int link) const { return awaited_[static_cast<std::size_t>(link)]; }
  /// Whether what a band waits for is in. Lets shadows take their steps.
  [[nodiscard]] bool poll(int link);
  /// Lets the exchange, and shadows, advance, where all that this step needs is in.
  void progress();
  /// Of a link over which all is in that this step needs.
  void advance_shadows(int link);
  [[nodiscard]] bool has_shadows() const { return map_.shape().depth > 0 && num_links() > 0; }
  /// Before a step, on all lanes.
  void begin_step(const StepFrame& frame);
  /// When the neighbour sent the message that is in [ns]; 0: not known, its clock is another one.
  [[nodiscard]] std::int64_t posted_at(int link) const {
    return shares_clock(link) ? exchange_->halo_times(link).posted : 0;
  }
  /// With the neighbour, on whose node this rank is.
  [[nodiscard]] bool shares_clock(int link) const {
    return shares_clock_[static_cast<std::size_t>(link)];
  }
  /// The messages that a band waits for: ghosts, or in the published scheme forces.
  /// @pre they are in
  void take_halos(int l, Side side);
  /// Pairs, rows: everything that a band needs. @pre take_halos
  void finish_band(int l, Side side);
  /// For the next step. @pre the band that sends over this tie is finished
  void send_halo(int l, int tie);
  /// After all bands of a lane. Lanes of a rank without neighbours may be in different steps.
  void end_step(int l);
  /// After all bands of all lanes: the next step's messages are expected.
  void end_step();
  /// Waits for the messages of this step and unpacks them, without computing; for measurements
  /// between steps.
  void complete_halo();
  /// What this rank waits for, as messages say it: "rank 0: halo of step 17 from rank 1".
  [[nodiscard]] std::string name_of_halo(int link) const;

  // ---- lists made anew
  /// Waits for halos on their way and drops them. @return when the last was sent [ns]; 0: not known
  std::int64_t discard_halo();
  /// Tests: at the end of lists shadows are held against their owners.
  void keep_shadows_level() { keeps_level_ = true; }
  /// The state has been changed between steps, but not that of shadows, until lists are made anew.
  void forget_shadows() { are_shadows_stale_ = true; }
  [[nodiscard]] bool are_shadows_stale() const { return are_shadows_stale_; }
  [[nodiscard]] bool keeps_shadows_level() const { return keeps_level_; }
  /// Of a link; null: none.
  [[nodiscard]] Shadows<Dim>* shadows(int link) const {
    return shadows_[static_cast<std::size_t>(link)].get();
  }
  /// Ghosts and lists are new: the next step needs no halo, and halos have these sizes.
  void begin_lists();
  [[nodiscard]] std::size_t most_halo_bytes() const;  ///< of a message to a neighbour

  [[nodiscard]] Exchange* exchange() const { return exchange_.get(); }  ///< null: no neighbours
  /// Continues with another exchange. Between new lists and the next step. Collective.
  void set_exchange(std::unique_ptr<Exchange> exchange);
  /// In the exchange, sending halos.
  [[nodiscard]] std::int64_t send_ns() const { return send_ns_; }
  /// When the last message was handed to the exchange: nobody notices it earlier.
  [[nodiscard]] std::int64_t sent_at() const { return sent_at_; }
  [[nodiscard]] std::int64_t shadow_ns() const;  ///< in steps of shadows
  /// Of messages to shadows, from the own one of that step until they were taken.
  [[nodiscard]] std::int64_t shadow_flight_ns() const { return flight_ns_; }
  void set_trace(Trace* trace) { trace_ = trace; }
  [[nodiscard]] Trace* trace() const { return trace_; }
  [[nodiscard]] std::int64_t num_owned() const;
  /// Where this rank's particles lie along the grid's first axis, least and most [m]; zeros without
  /// any.
  [[nodiscard]] std::pair<double, double> extent() const;
  [[nodiscard]] std::size_t bytes() const;
  std::int64_t step = 0;  ///< for messages

 private:
  using Bytes = std::vector<std::byte>;
  struct Post {                              ///< messages of one lane
    std::array<std::vector<Bytes>, 2> halo;  ///< by parity of the step that needs it, and tie
    int parity = 0;                          ///< of the step that the lane is in
    bool is_fresh = true;  ///< ghosts are up to date: nothing to unpack in this step
  };

  [[nodiscard]] Post& post(int l) { return posts_[static_cast<std::size_t>(l)]; }
  [[nodiscard]] const Post& post(int l) const { return posts_[static_cast<std::size_t>(l)]; }
  void set_fresh() {
    for (Post& p : posts_) p.is_fresh = true;
  }
  [[nodiscard]] bool returns() const { return scheme_ == CutScheme::Returned; }
  void tie_lanes();
  void wait_halo(int link);
  /// Of ghosts, which in the published scheme come from the left only.
  [[nodiscard]] bool awaits_ghosts(int link) const {
    return awaits(link) && !(returns() && end_of(link).side == Side::Right);
  }
  void take_halo(int l, int tie);
  [[nodiscard]] Rows deep_rows(int link) const;
  void send_deep(int link);
  bool take_deep(int link);
  void drain(int link);
  void await_none() { awaited_.assign(awaited_.size(), false); }
  [[nodiscard]] std::size_t most_results_bytes() const;  ///< of forces in the published scheme
  /// What the lane beside wrote for the step at hand. @pre the tie leads to a lane of this rank
  [[nodiscard]] const Bytes& inbox(int l, int tie) const;
  template <class Pack>
  void send(int link, std::size_t bytes, Pack&& pack);

  World<Dim>& world_;
  const Communicator& communicator_;
  std::unique_ptr<Exchange> exchange_;
  LaneMap map_;
  std::vector<std::vector<LaneTie>> ties_;  ///< by lane
  std::vector<LinkEnd> ends_;               ///< by link
  Neighbours neighbours_;
  CutScheme scheme_;
  std::deque<Lane<Dim>> lanes_;
  std::vector<Post> posts_;
  std::vector<std::unique_ptr<Shadows<Dim>>> shadows_;   ///< by link
  std::vector<std::vector<std::int64_t>> deep_sent_at_;  ///< by link, a ring by message [ns]
  bool keeps_level_ = false, are_shadows_stale_ = false;
  std::int64_t lists_step_ = 0, flight_ns_ = 0;
  std::vector<double> results_;     ///< of the published scheme, going or come
  std::vector<bool> shares_clock_;  ///< by link
  std::vector<bool> awaited_;       ///< by link: a message of another rank is due in this step
  std::int64_t halo_step_ = 0;      ///< that the halo on its way is for
  std::int64_t send_ns_ = 0, sent_at_ = 0;
  Trace* trace_ = nullptr;
};

extern template class Strip<2>;
extern template class Strip<3>;

}  // namespace barchan
