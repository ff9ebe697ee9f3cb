#pragma once

#include <vector>

#include <barchan/core/base/rows.hpp>
#include <barchan/core/search/cell_index.hpp>
#include <barchan/core/search/contact_search.hpp>
#include <barchan/core/search/pair_list.hpp>

namespace barchan {

/// One side of a lane: the cut, the owned rows along it, and the pairs across it.
struct Band {
  bool exists = false;
  bool returns = false;  ///< published scheme: the right-hand side computes the pairs of this cut
  Rows rows;             ///< owned rows that are somebody's ghosts
  CellIndex ghost_cells;
  Planes planes;                  ///< of the ghosts
  PairList across;                ///< first particles owned, second ones ghosts
  std::vector<PairBlock> blocks;  ///< of `across`
  bool has_quick = false;  ///< a ghost moved farther than World::quick_travel in the last step
  double travel = 0.0;     ///< bound of how far ghosts have come since the last rebuild [m]
};

}  // namespace barchan
