#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <barchan/core/base/side.hpp>
#include <barchan/core/brick/energy_works.hpp>
#include <barchan/core/brick/passage.hpp>
#include <barchan/core/brick/world.hpp>
#include <barchan/core/links/bonds.hpp>
#include <barchan/core/links/walls.hpp>
#include <barchan/core/particles/particle_store.hpp>
#include <barchan/core/search/band.hpp>
#include <barchan/core/search/cell_box.hpp>
#include <barchan/core/search/cell_index.hpp>
#include <barchan/core/search/pair_list.hpp>

namespace barchan {

/// Pairs that are worked on in one go, and the rows that are complete after them.
struct RowBlock : PairBlock {
  std::array<Rows, 2> to_come;  ///< rows to ask for (prefetch.hpp)
  std::int32_t final_row = 0;   ///< rows before this one are complete after the block
  bool has_extras = false;      ///< bonds, walls or external forces among them
};

/// A tie to one brick beside: which cells are ghosts here, and which rows are ghosts there.
template <int Dim>
struct BrickLink {
  Side side = Side::Left;  ///< the band that its ghosts are of
  CellBox<Dim> beyond;     ///< where the other brick lies
  CellRegion<Dim> sends;   ///< own cells that the other one needs
  CellRegion<Dim> takes;   ///< the other one's cells that this one needs
  std::vector<Rows> runs;  ///< owned rows of `sends`, by cells
  std::int32_t num_sent = 0;
  Rows ghosts;
  double travel = 0.0;     ///< bound of how far ghosts have come since the last rebuild [m]
  bool has_quick = false;  ///< a ghost moved farther than World::quick_travel in the last step
};

/// Which rows are complete when.
enum class CutForm {
  Strips,  ///< cuts along one axis: a slab beside each cut, complete when that cut is done
  Bricks   ///< cuts along any axes: all rows beside cuts, the rim, complete together
};

/// What one thread works on: a box of cells of the grid with their particles, what is between
/// these, and copies of the cells around it.
///
///      strips     ghosts |  band  |       interior        |  band  | ghosts      rows as drawn
///
///      bricks     ghosts of all links around | rim | interior              the rim comes first
///
/// Plain data. What works on it stands beside it: Rebuild, Lists and Step (lane.hpp), and functions
/// over bricks that they do not change: measure.hpp, diagnose.hpp, checkpoint.hpp.
template <int Dim>
struct Brick {
  World<Dim>* world = nullptr;
  CutForm form = CutForm::Strips;
  /// A slab beyond a cut between strips, stepped here as well (tasks/shadows.hpp).
  bool is_shadow = false;
  CellBox<Dim> box;

  // particles
  ParticleStore<Dim> store;
  CellIndex<Dim> cells;      ///< of owned rows and ghosts
  std::int32_t num_rim = 0;  ///< rows of the rim; bricks
  Rows interior;             ///< complete when the chunks are done

  // candidates
  PairList pairs;                       ///< of two owned particles
  std::vector<std::int64_t> row_begin;  ///< of every owned row its first place in `pairs`
  std::vector<RowBlock> blocks;         ///< of `pairs`
  std::vector<int> chunks{0};           ///< first block of each chunk, and the end
  std::array<Band, 2> bands;            ///< what is across the cuts, by side
  std::vector<BrickLink<Dim>> links;    ///< those of the left band first
  bool prefetches = false;
  double skin = 0.0;    ///< that the lists have [m]
  double travel = 0.0;  ///< bound of how far owned rows have come since the lists were made [m]
  double outrun = 0.0;  ///< of the last step with the lists before these, see outrun_share

  // links
  BondSet<Dim> bonds;
  BondedPairs bonded;
  WallContacts<Dim> walls;
  std::vector<WallSums> wall_sums;  ///< of all walls the work since the start
  EnergyWorks works;                ///< since the start; kept where World::accounts

  // the last step
  RowSpeeds speeds;          ///< of the owned rows
  double step_travel = 0.0;  ///< bound of how far owned rows moved [m]
  bool is_fast = false;      ///< a row moved farther than World::most_travel(), or is not finite
  bool has_quick = false;    ///< an owned row moved farther than World::quick_travel
  /// Two that passed each other in the step before the last one; of several the first.
  Passage passage;
  double top_flow = 0.0;  ///< largest sum of the sizes of a row's heat flows [W]

  explicit Brick(World<Dim>& of) : world(&of) {
    store.has_heat = of.heat.is_on;
    store.num_carried = of.num_carried;
  }
  Band& band(Side side) { return bands[index_of(side)]; }
  [[nodiscard]] const Band& band(Side side) const { return bands[index_of(side)]; }
  /// Ties it to one more brick, the left ones first. Before the brick owns anything.
  void add_link(Side side) {
    links.emplace_back().side = side;
    band(side).exists = true;
  }
  /// Strips, and their shadows, take the slab beside each cut, also where two in a ring meet at
  /// both ends.
  void place(const Placement<Dim>& at);
  [[nodiscard]] int num_chunks() const { return static_cast<int>(chunks.size()) - 1; }
  [[nodiscard]] std::int64_t num_pairs() const {
    std::int64_t n = pairs.size();
    for (const Band& band : bands) n += band.exists ? band.across.size() : 0;
    return n;
  }
  /// The bond is whole and counts here. What lies across a cut is on both sides, and counts on its
  /// right.
  [[nodiscard]] bool counts_bond(std::int32_t bond) const {
    return !bonds.is_broken(bond) &&
           std::max(bonds.end_a(bond), bonds.end_b(bond)) < store.ghost_begin(Side::Right);
  }
  /// Calls f(list, block) for all pairs that count here, block by block.
  template <class F>
  void for_each_counted(F&& f) const {
    for (const RowBlock& block : blocks) f(pairs, block);
    if (!band(Side::Left).exists) return;
    for (const PairBlock& block : band(Side::Left).blocks) f(band(Side::Left).across, block);
  }
};

extern template struct Brick<2>;
extern template struct Brick<3>;

}  // namespace barchan
