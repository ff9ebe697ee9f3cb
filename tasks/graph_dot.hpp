#pragma once

#include <string>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/tasks/step_tasks.hpp>

namespace barchan {

/// The tasks of one rank as a cluster of nodes, without the messages between ranks. Pure.
[[nodiscard]] std::string cluster_of(const GraphShape& shape, int rank);

/// The tasks of all ranks, and the messages between them, as a DOT file for Graphviz:
/// `dot -Tsvg graph.dot`. Complete on rank 0, empty elsewhere. Collective.
[[nodiscard]] std::string graph_dot(const Communicator& communicator, const GraphShape& shape);

}  // namespace barchan
