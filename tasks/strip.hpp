#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/comm/base/reduction.hpp>
#include <barchan/comm/slots/exchange.hpp>
#include <barchan/core/brick/lane.hpp>
#include <barchan/core/particles/share.hpp>
#include <barchan/tasks/trace.hpp>

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

/// The strip of one rank: its lanes, one per thread, and what passes between lanes and between
/// ranks.
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
  /// @param scheme_returns  the published exchange: ghosts go right, forces come back left
  Strip(World<Dim>& world, const Communicator& communicator, std::unique_ptr<Exchange> exchange,
        int num_lanes, bool scheme_returns);

  /// Cuts the domain for equal counts, keeps this rank's share, and builds all lists. Collective.
  void seed(const ParticleSet& set);

  /// Instead of seed: the state of a checkpoint, between steps. Collective.
  /// @param shares  one for each lane of this rank: particles between its cuts, and all that has an
  /// end among them
  void restore(std::vector<int> cuts, std::span<const CheckpointShare> shares);

  /// Migration, order by cells, ghosts, lists, history. Collective; leaves ghosts up to date.
  /// @param parallel  runs a function for every lane, on as many threads as there are
  using ForEachLane = std::function<void(const std::function<void(int)>&)>;
  void rebuild(const ForEachLane& parallel);

  // ---- the step; side is one of this rank's two, lane one of its lanes
  [[nodiscard]] int num_lanes() const { return static_cast<int>(lanes_.size()); }
  Lane<Dim>& lane(int l) { return *lanes_[static_cast<std::size_t>(l)]; }
  [[nodiscard]] const Lane<Dim>& lane(int l) const { return *lanes_[static_cast<std::size_t>(l)]; }
  [[nodiscard]] bool is_outer(int l, Side side) const {
    return side == Side::Left ? l == 0 : l + 1 == num_lanes();
  }
  /// Whether what lies beyond this side of a lane is another rank's.
  [[nodiscard]] bool is_remote(int l, Side side) const {
    return is_outer(l, side) && neighbours_.has(side);
  }
  /// The lane of this rank beside this one. Around the end of a periodic axis it may be itself.
  [[nodiscard]] int lane_beside(int l, Side side) const {
    return (l + (side == Side::Left ? num_lanes() - 1 : 1)) % num_lanes();
  }
  [[nodiscard]] bool scheme_returns() const { return returns_; }
  /// Whether this band must wait for a message of another rank in this step.
  [[nodiscard]] bool awaits(Side side) const { return awaited_[index_of(side)]; }
  [[nodiscard]] bool poll(Side side) { return exchange_->poll(side); }
  /// When the neighbour sent the message that is in [ns]; 0: not known, its clock is another one.
  [[nodiscard]] std::int64_t posted_at(Side side) const {
    return shares_clock_[index_of(side)] ? exchange_->halo_times(side).posted : 0;
  }
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

  [[nodiscard]] const std::vector<int>& cuts() const { return cuts_; }
  Exchange* exchange() { return exchange_.get(); }
  /// Continues with another exchange. Between a seed or rebuild and the next step. Collective.
  void set_exchange(std::unique_ptr<Exchange> exchange);
  [[nodiscard]] std::size_t most_halo_bytes() const;  ///< of a message to a neighbour
  /// In the exchange, sending halos.
  [[nodiscard]] std::int64_t send_ns() const { return send_ns_; }
  [[nodiscard]] const RebuildWaits& rebuild_waits() const { return waits_; }
  void restart_waits() { waits_ = {}; }  ///< setting up is not part of the loop
  void set_trace(Trace* trace) { trace_ = trace; }
  [[nodiscard]] const Neighbours& neighbours() const { return neighbours_; }
  [[nodiscard]] std::int64_t num_owned() const;
  /// Where this rank's particles lie along the strip axis, least and most [m]; zeros without any.
  [[nodiscard]] std::pair<double, double> extent() const;
  [[nodiscard]] std::int64_t num_rebuilds() const { return num_rebuilds_; }
  /// Particles that left this rank.
  [[nodiscard]] std::int64_t num_migrations() const { return num_migrations_; }
  [[nodiscard]] std::size_t bytes() const;
  /// What this rank waits for, as messages say it: "rank 0: halo of step 17 from rank 1 (right)".
  [[nodiscard]] std::string name_of_halo(Side side) const;
  std::int64_t step = 0;               ///< for messages
  std::int64_t chunk_pairs = 1 << 14;  ///< pairs per chunk from the next rebuild on

 private:
  using Bytes = std::vector<std::byte>;
  struct Post {  ///< messages of one lane
    std::array<Bytes, 2> out;
    std::array<std::array<Bytes, 2>, 2> halo;  ///< by parity of the step that needs it, and side
    int parity = 0;                            ///< of the step that the lane is in
    bool is_fresh = true;  ///< ghosts are up to date: nothing to unpack in this step
  };

  static constexpr int kMinSlabs = 2;  ///< of a lane: a particle lies in at most one band

  [[nodiscard]] Post& post(int l) { return posts_[static_cast<std::size_t>(l)]; }
  [[nodiscard]] const Post& post(int l) const { return posts_[static_cast<std::size_t>(l)]; }
  void set_fresh() {
    for (Post& p : posts_) p.is_fresh = true;
  }
  void place_bands();
  /// Before there are threads.
  ForEachLane one_by_one() const {
    return [this](const std::function<void(int)>& body) {
      for (int l = 0; l < num_lanes(); ++l) body(l);
    };
  }
  void discard_pending();
  void recut();
  void migrate(const ForEachLane& parallel);
  void exchange_ghosts(const ForEachLane& parallel);
  void wait_bulk(const char* what);
  void wait_halo(Side side);
  [[nodiscard]] bool has_neighbour(int l, Side side) const;
  /// What the lane beside wrote of its band, for the step at hand. @pre has_neighbour, !is_remote
  [[nodiscard]] const Bytes& inbox(int l, Side side) const;
  /// Sends the outermost posts. bulk() gives what came, from a rank or a lane; empty: none came.
  void begin_bulk();
  [[nodiscard]] std::span<const std::byte> bulk(int l, Side side) const;
  [[nodiscard]] int first_lane() const { return communicator_.rank() * num_lanes(); }
  [[nodiscard]] int total_lanes() const { return communicator_.size() * num_lanes(); }
  template <class Pack>
  void send_halo(Side side, std::size_t bytes, Pack&& pack);
  /// Since `begin`, for what a neighbour sent at `posted`; 0: not known
  void count_wait(double& seconds, Trace::Slice name, std::int64_t begin, std::int64_t posted);
  [[nodiscard]] std::int64_t bulk_posted_at() const;
  void begin_sizes();
  void reserve_posts();

  World<Dim>& world_;
  const Communicator& communicator_;
  std::unique_ptr<Exchange> exchange_;
  Reduction sizes_;
  Neighbours neighbours_;
  bool returns_;
  std::vector<std::unique_ptr<Lane<Dim>>> lanes_;
  std::vector<Post> posts_;
  std::vector<double> results_;  ///< of the published scheme, going or come
  std::vector<int> cuts_;
  std::array<bool, 2> shares_clock_{};  ///< with the neighbour, on whose node this rank is
  std::array<bool, 2> awaited_{};       ///< a message of another rank is due in this step
  std::int64_t halo_step_ = 0;          ///< that the halo on its way is for
  std::int64_t send_ns_ = 0;
  RebuildWaits waits_;
  std::int64_t bulk_begin_ = 0;
  Trace* trace_ = nullptr;
  std::int64_t num_rebuilds_ = 0, num_migrations_ = 0;
};

extern template class Strip<2>;
extern template class Strip<3>;

}  // namespace barchan
