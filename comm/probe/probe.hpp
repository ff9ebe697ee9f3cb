#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <barchan/comm/slots/exchange.hpp>
#include <barchan/comm/slots/obstacles.hpp>
#include <barchan/comm/topology/links.hpp>

namespace barchan {

/// What one exchange costs for messages of one size. Medians in seconds, of the slowest rank.
struct ExchangeCost {
  /// Between two neighbours, one after the other; for exchanges whose links go together, both ways
  /// at once.
  double half_round_trip = 0.0;
  double half_p99 = 0.0;      ///< of these trips, 99 in 100 are as short
  double half_most = 0.0;     ///< the longest of them
  double both_ways = 0.0;     ///< all ranks send to all neighbours and take what comes; no work
  double cpu = 0.0;           ///< inside the exchange per step, waiting at the end left out
  double overlap = 0.0;       ///< OSU: share of both_ways that work of the same length covers
  double availability = 0.0;  ///< SMB: share of both_ways that is free for work without any poll
};

/// The work of a step: its length, and its number of pieces, with a poll after each.
struct WorkPattern {
  double seconds = 0.0;
  int num_chunks = 1;
};

/// Measures one exchange on the real neighbours.
///
///   pure         send, wait                                            → both_ways
///   overlapped   send, (work piece, poll) …, wait; work = both_ways    → overlap, cpu
///   alone        send, work of twice that in one piece, wait           → availability
///
///   overlap      = max(0, 1 − (t_overlapped − t_work) / t_pure)      OSU micro-benchmarks
///   availability = 1 − (t_alone − t_work) / t_pure                   Sandia SMB, host availability
///
/// Construction and all members are collective over the communicator; one thread at a time. Errors:
/// those of the exchange.
class ExchangeProbe {
 public:
  /// @param bytes  of every message; reserved in the exchange
  /// @param budget_seconds  for each measurement, about; at least three repetitions are made
  ExchangeProbe(const Communicator& communicator, const Neighbours& neighbours, Exchange& exchange,
                std::size_t bytes, double budget_seconds);

  /// So many repetitions for each measurement, instead of what the budget allows.
  void repeat_exactly(int repetitions) { repetitions_ = repetitions; }

  [[nodiscard]] ExchangeCost measure();
  [[nodiscard]] double half_round_trip();
  /// What the exchange adds to a step with this work [s].
  [[nodiscard]] double exposed(const WorkPattern& work);

 private:
  /// Times of many repetitions.
  struct Spread {
    double median = 0.0, p99 = 0.0, most = 0.0;
  };
  static Spread spread_of(std::vector<double>& times);
  struct Step {
    double whole = 0.0, in_calls = 0.0;
  };
  Step step(const WorkPattern& work, bool polls);
  Step median_step(const WorkPattern& work, bool polls);
  double median_work(const WorkPattern& work);
  double both_ways();
  double bounce(int link, bool begins);
  [[nodiscard]] int link_between(int other, bool begins) const;
  Spread ping_pong(int parity);
  /// Of half a round trip; @pre both_ways() was called
  Spread half_trips();
  template <class Once>
  void repeat(Once&& once);
  [[nodiscard]] double slowest(double mine) const;
  void send(int link);
  bool poll_all();

  const Communicator& communicator_;
  Neighbours neighbours_;
  Exchange& exchange_;
  std::size_t bytes_;
  double budget_;
  int repetitions_ = 0;     ///< 0: by the budget
  double both_ways_ = 0.0;  ///< 0: not yet measured
  Spread wholes_;           ///< of the steps that were measured last
};

/// One line of a probe's table.
struct ProbeRow {
  std::string exchange;
  std::size_t bytes = 0;
  ExchangeCost cost;
};

struct ProbeReport {
  std::string mpi_library, thread_level;
  std::string window;          ///< component behind MPI_Win_allocate; empty: no window can be made
  int num_links = 0;           ///< pairs of neighbours
  int num_on_node = 0;         ///< of these, with both on one node
  std::vector<ProbeRow> rows;  ///< by exchange, then size
  std::vector<ProbeRow> plain_put;  ///< plain_put.hpp: half_round_trip only; empty without window
  std::vector<ExchangeObstacle> obstacles;
};

struct ProbeOptions {
  /// Empty: all, with the mixes that a run would try where links are of both kinds.
  std::vector<std::string> exchanges;
  std::vector<std::size_t> sizes = {64, 256, 1 << 10, 1 << 12, 1 << 14, 1 << 16, 1 << 18, 1 << 20};
  double budget_seconds = 0.05;  ///< for each of the five measurements of a row
  int repetitions = 0;           ///< of each instead; 0: by the budget
  ExchangeHooks hooks;
};

/// Measures all exchanges between neighbouring ranks. Collective; the same on every rank.
/// Errors: InputError for one rank only, or an unknown exchange.
[[nodiscard]] ProbeReport probe_exchanges(const Communicator& communicator,
                                          const ProbeOptions& options = {});

}  // namespace barchan
