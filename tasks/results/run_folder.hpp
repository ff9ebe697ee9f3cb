#pragma once

#include <string>

#include <barchan/tasks/results/own_files.hpp>

namespace barchan {

/// In a run's folder, as long as a run holds it; see FolderClaim.
inline constexpr const char* kLockName = "run.lock";

/// The folder of a run; docs/run_folder.md says what lies in it.
class RunFolder {
 public:
  explicit RunFolder(std::string path) : path_(std::move(path)) {}

  /// `<stem of the deck>.out` in the current directory.
  static RunFolder of_deck(const std::string& deck_path);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }

  /// Would begin() do? Changes nothing. One rank.
  /// Errors: InputError when it has files in it and may not be replaced, is a file, or cannot be
  /// written; when it may be replaced and has files that are not a run's where results belong.
  void check(bool may_replace) const;

  /// Makes the folder and removes what earlier runs wrote, nothing else; where other files are in
  /// the way, it removes nothing. One rank. Errors: InputError.
  void begin() const;

  /// Prepares to continue with the results in the folder. One rank. Errors: InputError.
  void resume() const;
  /// Results are no longer those of a run that has ended. One rank. Errors: InputError.
  void reopen() const;

 private:
  [[nodiscard]] OwnFiles own_files() const;

  std::string path_;
};

}  // namespace barchan
