#include <barchan/comm/probe.hpp>

#include <algorithm>

#include <barchan/comm/mpi_error.hpp>
#include <barchan/comm/mpi_session.hpp>
#include <barchan/comm/plain_put.hpp>
#include <barchan/comm/window.hpp>
#include <barchan/core/error.hpp>

namespace barchan {
namespace {

/// The lowest rank that shares memory with this one.
std::int64_t node_of(const Communicator& communicator) {
  MPI_Comm node = MPI_COMM_NULL;
  check(MPI_Comm_split_type(communicator.handle(), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node),
        "MPI_Comm_split_type");
  std::int64_t lowest = communicator.rank();
  const int code = MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPI_INT64_T, MPI_MIN, node);
  check(MPI_Comm_free(&node), "MPI_Comm_free");
  check(code, "MPI_Allreduce");
  return lowest;
}

void probe_sizes(const Communicator& communicator, Neighbours neighbours, const std::string& name,
                 const ProbeOptions& options, ProbeReport& report) {
  ExchangeOptions first;
  first.halo_bytes = *std::ranges::max_element(options.sizes);
  const auto exchange = make_exchange(name, communicator, neighbours, first);
  for (const std::size_t bytes : options.sizes) {
    ExchangeProbe probe(communicator, neighbours, *exchange, bytes, options.budget_seconds);
    report.rows.push_back({name, bytes, probe.measure()});
  }
}

void probe_plain_put(const Communicator& communicator, const ProbeOptions& options,
                     ProbeReport& report) {
  for (const std::size_t bytes : options.sizes) {
    ProbeRow row{"plain put", bytes, {}};
    row.cost.half_round_trip =
        plain_put_half_round_trip(communicator, bytes, options.budget_seconds);
    report.plain_put.push_back(row);
  }
}

std::string window_component(const Communicator& communicator) {
  try {
    return Window(communicator, 64).component();
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

std::vector<std::int64_t> nodes_of_ranks(const Communicator& communicator) {
  std::vector<std::int64_t> nodes(static_cast<std::size_t>(communicator.size()), 0);
  nodes[static_cast<std::size_t>(communicator.rank())] = node_of(communicator);
  communicator.allreduce_sum(std::span<std::int64_t>(nodes));
  return nodes;
}

Links count_links(const Communicator& communicator, Neighbours neighbours) {
  const auto nodes = nodes_of_ranks(communicator);
  std::int64_t counts[2] = {};
  if (neighbours.has(Side::Right)) {
    counts[0] = 1;
    counts[1] = nodes[static_cast<std::size_t>(neighbours.right)] ==
                nodes[static_cast<std::size_t>(communicator.rank())];
  }
  communicator.allreduce_sum(std::span<std::int64_t>(counts));
  return {static_cast<int>(counts[0]), static_cast<int>(counts[1])};
}

ProbeReport probe_exchanges(const Communicator& communicator, const ProbeOptions& options) {
  if (communicator.size() < 2) {
    throw InputError("a probe needs at least two ranks",
                     "mpirun -n 2 barchan probe, on the nodes that a run would use");
  }
  const Neighbours neighbours = strip_neighbours(communicator.rank(), communicator.size(), false);
  ProbeReport report;
  report.mpi_library = mpi_library_version();
  report.thread_level = mpi_thread_level();
  report.window = window_component(communicator);
  const Links links = count_links(communicator, neighbours);
  report.num_links = links.all;
  report.num_on_node = links.on_node;
  const auto names = options.exchanges.empty() ? exchange_names() : options.exchanges;
  for (const std::string& name : names) (void)exchange_summary(name);  // unknown ones first
  if (!report.window.empty()) probe_plain_put(communicator, options, report);
  for (const std::string& name : names) {
    try {
      probe_sizes(communicator, neighbours, name, options, report);
    } catch (const InputError& e) {
      report.obstacles.push_back({name, e.what()});
    }
  }
  return report;
}

}  // namespace barchan
