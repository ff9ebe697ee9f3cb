#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <barchan/comm/topology/neighbours.hpp>
#include <barchan/core/base/side.hpp>
#include <barchan/core/brick/brick.hpp>

namespace barchan {

/// How many ranks, and lanes of each rank, stand beside each other along the grid's axes.
struct CutShape {
  CutForm form = CutForm::Strips;
  std::array<int, 3> ranks{1, 1, 1};
  std::array<int, 3> lanes{1, 1, 1};  ///< of a rank
  int depth = 0;  ///< strips: slabs beyond each cut between ranks that are stepped here, too

  [[nodiscard]] int along(int axis) const {
    const auto k = static_cast<std::size_t>(axis);
    return ranks[k] * lanes[k];
  }
  [[nodiscard]] int num_ranks() const { return ranks[0] * ranks[1] * ranks[2]; }
  [[nodiscard]] int num_lanes() const { return lanes[0] * lanes[1] * lanes[2]; }
  friend bool operator==(const CutShape&, const CutShape&) = default;
};

/// One lane's link to another.
struct LaneTie {
  Side side = Side::Left;  ///< the band that it belongs to
  int rank = 0, lane = 0;  ///< the other one
  int back = 0;            ///< number of this tie among those of the other one
  int link = -1;           ///< of this rank's exchange; −1: the other one is of this rank
  int peer = -1;           ///< of the other rank's, the same
};

/// Which lanes are beside which, all ranks' lanes in one block of numbers along each axis:
///
///     ranks    |       0       |       1       |
///     lanes    |   0   |   1   |   0   |   1   |       each of these again along the other axes
///
/// A tie leads to every lane that touches, over faces, edges and corners, and around the ends of
/// periodic axes; one tie to each, but for strips, which in a ring of two have a left and a right
/// one. In bricks, ties to lanes with lower numbers are left ones. Pure: every rank finds the same.
class LaneMap {
 public:
  using Place = std::array<int, 3>;

  LaneMap(const CutShape& shape, const std::array<bool, 3>& is_periodic);

  [[nodiscard]] const CutShape& shape() const { return shape_; }
  /// Where a lane stands among all along each axis.
  [[nodiscard]] Place place(int rank, int lane) const;
  /// By lane of a rank; links are numbered in this order.
  [[nodiscard]] std::vector<std::vector<LaneTie>> ties(int rank) const;

 private:
  [[nodiscard]] std::vector<LaneTie> ties_of(int rank, int lane) const;
  [[nodiscard]] std::vector<std::vector<LaneTie>> with_links(int rank) const;
  void add_strip_ties(int at, std::vector<LaneTie>& ties) const;
  void add_brick_ties(const Place& at, std::vector<LaneTie>& ties) const;
  [[nodiscard]] LaneTie tie_to(const Place& at) const;
  [[nodiscard]] int number(const LaneTie& tie) const {
    return tie.rank * shape_.num_lanes() + tie.lane;
  }
  [[nodiscard]] int back_of(const LaneTie& tie, int rank, int lane) const;

  CutShape shape_;
  std::array<bool, 3> is_periodic_;
};

/// What the exchange of a rank has to know of its lanes' ties.
[[nodiscard]] Neighbours neighbours_of(const std::vector<std::vector<LaneTie>>& ties);

/// Where cuts lie along each axis: lane n of an axis has the cells cuts[n] … cuts[n+1] − 1.
using Cuts = std::array<std::vector<int>, 3>;

/// The cells of a lane, and of those that its ties lead to.
template <int Dim>
[[nodiscard]] Placement<Dim> placement(const LaneMap& map, const Cuts& cuts, int rank, int lane,
                                       const std::vector<LaneTie>& ties);

extern template Placement<2> placement(const LaneMap&, const Cuts&, int, int,
                                       const std::vector<LaneTie>&);
extern template Placement<3> placement(const LaneMap&, const Cuts&, int, int,
                                       const std::vector<LaneTie>&);

}  // namespace barchan
