#pragma once

#include <cstdint>

namespace barchan {

/// Half-open range of particle indices.
struct Rows {
  std::int32_t begin = 0, end = 0;
  [[nodiscard]] std::int32_t size() const { return end - begin; }
};

}  // namespace barchan
