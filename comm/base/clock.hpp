#pragma once

#include <chrono>
#include <cstdint>

namespace barchan {

/// Steady clock [ns]; the same clock for every process of a node.
inline std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace barchan
