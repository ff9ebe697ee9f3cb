#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace barchan {

/// The pairs of ids that hold an intact bond, for the contact search.
class BondedPairs {
 public:
  void clear() { pairs_.clear(); }
  void add(std::int64_t a, std::int64_t b) { pairs_.emplace_back(std::min(a, b), std::max(a, b)); }
  void finish() { std::sort(pairs_.begin(), pairs_.end()); }
  [[nodiscard]] bool contains(std::int64_t a, std::int64_t b) const {
    return std::binary_search(pairs_.begin(), pairs_.end(),
                              std::pair{std::min(a, b), std::max(a, b)});
  }

 private:
  std::vector<std::pair<std::int64_t, std::int64_t>> pairs_;
};

}  // namespace barchan
