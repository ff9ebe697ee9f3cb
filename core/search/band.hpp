#pragma once

#include <vector>

#include <barchan/core/base/rows.hpp>
#include <barchan/core/search/contact_search.hpp>
#include <barchan/core/search/pair_list.hpp>

namespace barchan {

/// One side of a brick: what lies beyond it, and the pairs across it. Of a strip the left and the
/// right cut; of other bricks all links to those that come before it, and to those after it.
struct Band {
  bool exists = false;
  bool returns = false;  ///< published scheme: the right-hand side computes the pairs of this cut
  Rows near;             ///< owned rows that may have partners across
  Rows rows;             ///< owned rows that are complete when this side is done
  Planes planes;         ///< of the ghosts
  PairList across;       ///< first particles owned, second ones ghosts
  std::vector<PairBlock> blocks;  ///< of `across`
  bool has_quick = false;  ///< a ghost moved farther than World::quick_travel in the last step
  double travel = 0.0;     ///< bound of how far ghosts have come since the last rebuild [m]
};

}  // namespace barchan
