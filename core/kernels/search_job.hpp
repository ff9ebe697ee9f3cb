#pragma once

#include <cstdint>

#include <barchan/core/kernels/pair_job.hpp>

namespace barchan {

/// One particle against a range of others, whose coordinates lie axis by axis.
struct SearchJob {
  const double* x[3] = {};         ///< from row `first` on, readable one batch beyond the end [m]
  const double* radius = nullptr;  ///< likewise [m]
  std::int32_t first = 0;
  double at[3] = {}, reach = 0.0;  ///< this one's position, radius and skin [m]
  PeriodicBox box;
};

/// Writes those of rows [begin, end) that are within reach, in order, and returns how many.
/// @pre room for end − begin and one batch more
using SearchKernel = int (*)(const SearchJob&, std::int32_t begin, std::int32_t end,
                             std::int32_t* found);

}  // namespace barchan
