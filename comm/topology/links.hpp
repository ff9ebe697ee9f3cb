#pragma once

#include <cstdint>
#include <vector>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/comm/topology/neighbours.hpp>

namespace barchan {

/// For each rank a number that ranks share when they share memory: the lowest rank of their node.
/// Collective.
/// @param ranks_per_node  tests: this many ranks in a row count as a node; 0: the real nodes
[[nodiscard]] std::vector<std::int64_t> nodes_of_ranks(const Communicator& communicator,
                                                       int ranks_per_node = 0);

/// How many links there are in all, and of how many both ranks share a node. Collective.
struct Links {
  int all = 0, on_node = 0;

  [[nodiscard]] bool are_of_both_kinds() const { return on_node > 0 && on_node < all; }
};
[[nodiscard]] Links count_links(const Communicator& communicator, const Neighbours& neighbours,
                                int ranks_per_node = 0);

}  // namespace barchan
