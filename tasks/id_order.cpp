#include <barchan/tasks/id_order.hpp>

#include <algorithm>
#include <functional>
#include <numeric>

namespace barchan {

/// Ids mostly count from 1 without many gaps: then each is put in its place.
std::vector<std::size_t> order_of(std::span<const std::int64_t> ids) {
  std::vector<std::size_t> order(ids.size());
  const std::int64_t highest = ids.empty() ? 0 : *std::max_element(ids.begin(), ids.end());
  if (highest / 4 > static_cast<std::int64_t>(ids.size())) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
    return order;
  }
  constexpr auto kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> place(static_cast<std::size_t>(highest) + 1, kNone);
  for (std::size_t k = 0; k < ids.size(); ++k) place[static_cast<std::size_t>(ids[k])] = k;
  std::copy_if(place.begin(), place.end(), order.begin(), [](std::size_t k) { return k != kNone; });
  return order;
}

std::int64_t twin_among(std::span<const std::int64_t> ids) {
  if (std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<>()) == ids.end()) return 0;
  std::vector<std::int64_t> sorted(ids.begin(), ids.end());
  std::sort(sorted.begin(), sorted.end());
  const auto twin = std::adjacent_find(sorted.begin(), sorted.end());
  return twin == sorted.end() ? 0 : *twin;
}

}  // namespace barchan
