#pragma once

#include <string>
#include <vector>

#include <barchan/tasks/simulation.hpp>

namespace barchan {

/// `log.txt` of a run folder: a line for everything that a run did beside its steps. Each line is
/// on its way to the disk before the call returns. Rank 0 writes; when the log cannot be written,
/// it stops, since no result depends on it.
class RunLog {
 public:
  /// @param continues  appends to the log in the folder
  RunLog(const Simulation& simulation, std::string path, bool continues);

  /// Takes the notes of all ranks. Collective.
  void take_notes(Simulation& simulation);
  /// A line of the caller. On rank 0; elsewhere nothing happens. Local.
  void add(const std::string& line);
  /// A line that take_warnings() tells as well. On rank 0; local.
  void warn(const std::string& text);
  /// Warnings, those among the notes too, since the last call. On rank 0; local.
  [[nodiscard]] std::vector<std::string> take_warnings();

 private:
  std::string path_;  ///< empty where nothing is written
  std::string last_checkpoint_;
  std::vector<std::string> warnings_;
};

}  // namespace barchan
