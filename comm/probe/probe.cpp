#include <barchan/comm/probe/probe.hpp>

#include <algorithm>

#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/comm/base/window.hpp>
#include <barchan/comm/exchanges/make_exchange.hpp>
#include <barchan/comm/probe/auto_exchange.hpp>
#include <barchan/comm/slots/plain_put.hpp>
#include <barchan/comm/wrappers/mixed_exchange.hpp>
#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

void probe_sizes(const Communicator& communicator, const Neighbours& neighbours,
                 const std::string& name, const ProbeOptions& options, ProbeReport& report) {
  ExchangeOptions first;
  first.halo_bytes = *std::ranges::max_element(options.sizes);
  first.hooks = options.hooks;
  const auto exchange = make_exchange(name, communicator, neighbours, first);
  for (const std::size_t bytes : options.sizes) {
    ExchangeProbe probe(communicator, neighbours, *exchange, bytes, options.budget_seconds);
    probe.repeat_exactly(options.repetitions);
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

void check_sizes(const std::vector<std::size_t>& sizes) {
  constexpr std::size_t most = 2147483647 - 128;  // of one MPI call, with header and trailer
  const std::size_t largest = *std::ranges::max_element(sizes);
  if (largest <= most) return;
  throw InputError(
      "messages of " + std::to_string(largest) + " bytes are more than one MPI call moves",
      "use a smaller --bytes, at most " + std::to_string(most));
}

std::vector<std::string> all_names(const Links& links) {
  std::vector<std::string> names = exchange_names();
  for (const std::string& name : auto_candidates(links)) {
    if (ExchangeMix::parse(name)) names.push_back(name);
  }
  return names;
}

std::string window_component(const Communicator& communicator) {
  try {
    return Window(communicator, 64).component();
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

ProbeReport probe_exchanges(const Communicator& communicator, const ProbeOptions& options) {
  if (communicator.size() < 2) {
    throw InputError("a probe needs at least two ranks",
                     "mpirun -n 2 barchan probe, on the nodes that a run would use");
  }
  check_sizes(options.sizes);
  const Neighbours neighbours = strip_neighbours(communicator.rank(), communicator.size(), false);
  ProbeReport report;
  report.mpi_library = mpi_library_version();
  report.thread_level = mpi_thread_level();
  report.window = window_component(communicator);
  const Links links = count_links(communicator, neighbours, options.hooks.ranks_per_node);
  report.num_links = links.all;
  report.num_on_node = links.on_node;
  const auto names = options.exchanges.empty() ? all_names(links) : options.exchanges;
  for (const std::string& name : names) check_exchange_name(name);  // unknown ones first
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
