#pragma once

#include <string>
#include <vector>

#include <barchan/comm/communicator.hpp>
#include <barchan/comm/neighbours.hpp>

namespace barchan {

/// The step graph of one rank: what it has nodes and edges for.
struct GraphShape {
  struct LaneShape {
    int num_chunks = 0;
    bool has_left = false, has_right = false;            ///< bands
    bool is_outer_left = false, is_outer_right = false;  ///< bands at the strip's ends
  };
  std::vector<LaneShape> lanes;
  Neighbours neighbours;
  bool is_sequential = false;
};

/// The graph of one rank as a cluster of nodes, without the messages between ranks. Pure.
[[nodiscard]] std::string cluster_of(const GraphShape& shape, int rank);

/// The graphs of all ranks, and the messages between them, as a DOT file for Graphviz:
/// `dot -Tsvg graph.dot`. Complete on rank 0, empty elsewhere. Collective.
[[nodiscard]] std::string graph_dot(const Communicator& communicator, const GraphShape& shape);

}  // namespace barchan
