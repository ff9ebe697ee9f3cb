#pragma once

#include <string>
#include <utility>
#include <vector>

#include <barchan/core/io/vtp.hpp>
#include <barchan/tasks/simulation.hpp>

namespace barchan {

/// Snapshots of a run: one piece a rank, a .pvtp a time, a .pvd in all; where the deck has bond
/// laws the same for bonds, in files beside those of the particles (bonds_path).
class SnapshotWriter {
 public:
  explicit SnapshotWriter(std::string folder) : folder_(std::move(folder)) {}

  /// Keeps the snapshots in the folder that are before the present step and at multiples of
  /// `every`; removes the others, which an earlier run wrote at its end or later. Collective.
  /// Errors: RunError.
  void resume(const Simulation& simulation, std::int64_t every);
  /// The present state. Collective. Errors: RunError.
  void write(Simulation& simulation);
  [[nodiscard]] std::int64_t last_step() const { return last_step_; }  ///< -1: none yet

 private:
  void write_bonds(Simulation& simulation);
  void write_whole(const std::string& name, const VtpArrays& arrays, const Simulation& simulation);

  std::string folder_;
  std::vector<PvdEntry> entries_;
  std::int64_t last_step_ = -1;
};

}  // namespace barchan
