#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <barchan/core/model.hpp>

namespace barchan {

enum class Schedule { Overlap, Sequential };

/// How a run is carried out. Nothing in here changes a bit of the result.
struct RunOptions {
  int threads = 0;                    ///< per rank; 0 = cores of the node over ranks on it
  std::string exchange = "put-flag";  ///< see exchange_choices()
  Schedule schedule = Schedule::Overlap;
  std::optional<ContactSearchKind> search;  ///< instead of the deck's
  std::string vector = "auto";              ///< scalar, avx2, avx512 or the widest here
  double max_delay_seconds = 0.0;           ///< tests: random delays in messages and tasks
  std::uint64_t delay_seed = 0;
};

}  // namespace barchan
