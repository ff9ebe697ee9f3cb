#pragma once

#include <cstdint>

namespace barchan {

/// A bond that broke in a step. Plain data: it travels between ranks.
struct BondBreak {
  std::int64_t step = 0;            ///< that found it too strong a pull: the state at its beginning
  std::int64_t id_a = 0, id_b = 0;  ///< the lower id first
};

}  // namespace barchan
