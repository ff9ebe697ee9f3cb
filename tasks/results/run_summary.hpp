#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <barchan/tasks/simulation.hpp>
#include <barchan/tasks/stability.hpp>

namespace barchan {

/// What ran where.
struct Machine {
  std::string host;       ///< of rank 0
  std::string processor;  ///< its model, empty where the system does not tell
  int cores = 0;          ///< of that host, as the system counts them
  int hosts = 1;          ///< different ones among all ranks
  std::string mpi;        ///< library and version
};

/// A run in numbers, over all ranks: what run.json holds.
struct RunSummary {
  std::string version, deck, title;
  std::vector<SourceKey> deck_keys;  ///< what the deck says
  int dimension = 2;
  int ranks = 1, threads = 1;  ///< threads per rank
  CutsInUse cuts;
  std::string exchange, schedule, progress, contact_search, transport, vector;
  Machine machine;
  std::int64_t particles = 0, steps = 0;
  double dt = 0.0, time = 0.0;  ///< [s]
  double skin = 0.0;            ///< [m]
  double force_grain = 0.0;     ///< [N]
  double gravity = 0.0;         ///< its size [m/s²]
  std::optional<StepLimit> limit;
  double loop_seconds = 0.0;    ///< of the slowest rank
  std::int64_t loop_steps = 0;  ///< that it took; fewer than `steps` after a restart
  std::int64_t rebuilds = 0, migrations = 0;
  double memory_bytes = 0.0;                               ///< all ranks
  std::map<std::string, double> phases;                    ///< seconds per rank, averaged
  std::map<std::string, double> phases_most;               ///< of the rank with the most
  std::vector<double> lanes_worked;                        ///< of all ranks; see Timings
  double in_flight_seconds = 0.0, exposed_seconds = 0.0;   ///< per rank, averaged
  double exposed_most = 0.0;                               ///< of the rank with the most
  std::map<std::string, CommunicationTime> communication;  ///< by kind; per rank, averaged
  ExchangeChoice choice;
  std::uint64_t messages = 0, bytes = 0;  ///< sent by all ranks
  std::vector<std::int64_t> owned;        ///< particles of each rank
  Measures measures;
  std::optional<EnergyBudget> budget;  ///< with output.energy
  std::vector<WallSpec> wall_specs;
  std::vector<WallState> walls;
  std::uint64_t digest = 0;
  LeftDomain left;
  bool interrupted = false;

  [[nodiscard]] double particle_steps_per_second() const;
  /// Work of the lane that worked most, over the mean; 1 where nobody worked.
  [[nodiscard]] double imbalance() const;
  /// Share of the time in flight in which there was work to do; 1 where nothing was in flight.
  [[nodiscard]] double hidden_fraction() const;
  [[nodiscard]] double potential() const;  ///< elastic and gravitational [J]
  /// The grain over the weight of the lightest particle that moves; none without gravity.
  [[nodiscard]] std::optional<double> grain_of_smallest_weight() const;
};

/// Collects the numbers of all ranks. Complete on rank 0; elsewhere times and counts are those of
/// that rank. Collective.
[[nodiscard]] RunSummary summarize(Simulation& simulation, const std::string& deck,
                                   const std::optional<StepLimit>& limit, bool interrupted);

/// run.json, complete or not at all. One rank. Errors: RunError.
void write_run_json(const std::string& path, const RunSummary& summary);

[[nodiscard]] std::string version();  ///< of barchan

}  // namespace barchan
