#pragma once

#include <cstdint>

#include <barchan/core/base/rows.hpp>
#include <barchan/core/kernels/pair_job.hpp>

namespace barchan {

/// One particle against ranges of others, whose coordinates lie axis by axis.
struct SearchJob {
  const double* x[3] = {};         ///< from row `first` on, readable one batch beyond the end [m]
  const double* radius = nullptr;  ///< likewise [m]
  std::int32_t first = 0;
  double at[3] = {}, reach = 0.0;  ///< this one's position, radius and skin [m]
  bool wraps = false;              ///< others may be nearer around an end of the box
  PeriodicBox box;
};

/// Writes those rows of `count` ranges that are within reach, in order, and returns how many.
/// @pre room for all rows and one batch more
using SearchKernel = int (*)(const SearchJob&, const Rows* ranges, int count, std::int32_t* found);

}  // namespace barchan
