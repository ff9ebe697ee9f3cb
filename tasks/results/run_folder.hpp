#pragma once

#include <string>

namespace barchan {

/// The folder of a run; docs/run_folder.md says what lies in it.
class RunFolder {
 public:
  explicit RunFolder(std::string path) : path_(std::move(path)) {}

  /// `<stem of the deck>.out` in the current directory.
  static RunFolder of_deck(const std::string& deck_path);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }

  /// Would begin() do? Changes nothing. One rank.
  /// Errors: InputError when it exists and may not be replaced, is a file, or cannot be written.
  void check(bool may_replace) const;

  /// Makes the folder and removes what an earlier run left: all that has the name of a result,
  /// nothing else. One rank. Errors: InputError.
  void begin() const;

  /// Prepares to continue with the results in the folder. One rank. Errors: InputError.
  void resume() const;

 private:
  std::string path_;
};

}  // namespace barchan
