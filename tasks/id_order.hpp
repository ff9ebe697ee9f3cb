#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace barchan {

/// Where in `ids` the lowest is, the next one, and so on. @pre none is there twice, or below 1
[[nodiscard]] std::vector<std::size_t> order_of(std::span<const std::int64_t> ids);

/// An id that is there twice; 0: none.
[[nodiscard]] std::int64_t twin_among(std::span<const std::int64_t> ids);

}  // namespace barchan
