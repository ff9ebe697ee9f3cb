#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <barchan/tasks/results/run_folder.hpp>
#include <barchan/tasks/results/run_log.hpp>
#include <barchan/tasks/results/run_summary.hpp>
#include <barchan/tasks/results/series_table.hpp>
#include <barchan/tasks/results/snapshots.hpp>

namespace barchan {

/// What the results name and the simulation does not know.
struct ResultsSpec {
  std::string deck;                ///< as the user named it
  std::vector<Ring> rings;         ///< whose diameters go into the series
  std::optional<StepLimit> limit;  ///< smallest of step_limits()
  bool continues = false;          ///< the folder is that of the checkpoint the simulation is from
  std::vector<SourceKey> deck_keys = {};  ///< Deck::keys
};

/// Writes a run's folder as its deck says:
///
///     RunResults results(sim, RunFolder("case.out"), particles, {"case.toml"});
///     while (sim.step() < end && !sim.stopped()) {
///       sim.run(std::min(results.next_step(), end) - sim.step());
///       results.write();
///     }
///     results.finish();
///
/// Everything is collective. Errors, the same on every rank: InputError from the constructor when
/// the folder cannot be made; RunError when a file cannot be written.
class RunResults {
 public:
  /// Clears the folder and writes the present state; the caller has a FolderClaim, or has called
  /// RunFolder::check. When it continues, removes the results of later steps, so that the files end
  /// like those of a run without interruption.
  /// @param simulation  lives longer
  RunResults(Simulation& simulation, RunFolder folder, const ParticleSet& particles,
             ResultsSpec spec);

  [[nodiscard]] std::int64_t next_step()
      const;     ///< at which something is due; after the present one
  void write();  ///< what is due at the present step
  /// After an AgreedError: a row and a snapshot of the present state.
  void write_failed();
  [[nodiscard]] RunLog& log() { return *log_; }
  /// The last row and snapshot, the picture and run.json. @return complete on rank 0
  RunSummary finish(bool interrupted = false);

 private:
  void on_rank_zero(const std::function<void()>& work);
  void append_row();
  void list_departures();

  Simulation& simulation_;
  RunFolder folder_;
  ResultsSpec spec_;
  std::int64_t series_every_, snapshots_every_;
  std::optional<RunLog> log_;
  std::optional<SeriesTable> series_;
  SnapshotWriter snapshots_;
  std::int64_t last_row_ = -1;
};

}  // namespace barchan
