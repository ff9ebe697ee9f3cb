#pragma once

#include <optional>
#include <string>
#include <vector>

#include <barchan/core/io/lock_file.hpp>
#include <barchan/tasks/results/run_folder.hpp>

namespace barchan {

/// Holds a run's folder for one run, from before the folder is looked at until the run has ended:
/// makes the folder when there is none and locks the file `run.lock` in it, which says who holds
/// it. A second run of the same folder is refused; what a dead process holds is taken over. Changes
/// nothing else. One rank.
class FolderClaim {
 public:
  /// @param may_exist  whether a folder with files in it will do
  /// Errors: InputError: another run holds the folder; it is a file, cannot be written, or exists.
  FolderClaim(const RunFolder& folder, bool may_exist);
  /// Gives the folder back; removes those that it made, as far as they are still empty.
  ~FolderClaim();
  FolderClaim(const FolderClaim&) = delete;
  FolderClaim& operator=(const FolderClaim&) = delete;

  /// Which process held the folder and died; empty when none did.
  [[nodiscard]] const std::string& former() const { return lock_->former(); }

 private:
  void make_folders(const std::string& path);
  void lock(const RunFolder& folder);
  void remove_empty() noexcept;

  std::vector<std::string> made_;  ///< outermost first
  std::optional<LockFile> lock_;
};

}  // namespace barchan
