#pragma once

namespace barchan {

/// Who computes the pairs across a cut between two ranks.
enum class CutScheme {
  BothSides,  ///< both ranks: ghosts go both ways
  Returned    ///< published scheme: the right one; ghosts go right, their forces come back left
};

}  // namespace barchan
