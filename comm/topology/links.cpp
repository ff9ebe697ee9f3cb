#include <barchan/comm/topology/links.hpp>

#include <barchan/comm/base/call_watch.hpp>
#include <barchan/comm/base/mpi_error.hpp>

namespace barchan {
namespace {

/// The lowest rank that shares memory with this one.
std::int64_t node_of(const Communicator& communicator) {
  MPI_Comm node = MPI_COMM_NULL;
  check_watched("MPI_Comm_split_type", [&] {
    return MPI_Comm_split_type(communicator.handle(), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL,
                               &node);
  });
  std::int64_t lowest = communicator.rank();
  check_watched("MPI_Allreduce", [&] {
    return MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPI_INT64_T, MPI_MIN, node);
  });
  check_watched("MPI_Comm_free", [&] { return MPI_Comm_free(&node); });
  return lowest;
}

}  // namespace

std::vector<std::int64_t> nodes_of_ranks(const Communicator& communicator, int ranks_per_node) {
  std::vector<std::int64_t> nodes(static_cast<std::size_t>(communicator.size()), 0);
  const int rank = communicator.rank();
  nodes[static_cast<std::size_t>(rank)] =
      ranks_per_node > 0 ? rank / ranks_per_node * ranks_per_node : node_of(communicator);
  communicator.allreduce_sum(std::span<std::int64_t>(nodes));
  return nodes;
}

Links count_links(const Communicator& communicator, const Neighbours& neighbours,
                  int ranks_per_node) {
  const auto nodes = nodes_of_ranks(communicator, ranks_per_node);
  std::int64_t ends[2] = {};
  for (int link = 0; link < neighbours.num_links(); ++link) {
    if (!neighbours.has(link)) continue;
    ++ends[0];
    ends[1] += nodes[static_cast<std::size_t>(neighbours.rank(link))] ==
                       nodes[static_cast<std::size_t>(communicator.rank())]
                   ? 1
                   : 0;
  }
  communicator.allreduce_sum(std::span<std::int64_t>(ends));
  return {static_cast<int>(ends[0] / 2), static_cast<int>(ends[1] / 2)};
}

}  // namespace barchan
