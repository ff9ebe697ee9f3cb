#pragma once

#include <optional>
#include <string>

namespace barchan {

/// A file that one process at a time holds: an advisory lock (flock) on it, and in it who holds it.
/// The kernel gives the lock back when its process ends, however that was, so a file that a dead
/// process left is taken over. Where a file system knows no locks, the process that the file names
/// must be known to be dead: it ran on this host and is not there any more.
///
///     host lab1
///     pid 4242
///     started 81250        ticks since the host was booted
///     since 2024-05-01 12:00:00 UTC
class LockFile {
 public:
  /// @return nothing when another process holds it; `holder` then says which.
  /// Errors: FileError when the file cannot be made.
  static std::optional<LockFile> acquire(const std::string& path, std::string& holder);
  /// Removes the file.
  ~LockFile();
  LockFile(LockFile&& other) noexcept;
  LockFile& operator=(LockFile&&) = delete;

  /// Who left the file without giving it back; empty when it was free.
  [[nodiscard]] const std::string& former() const { return former_; }

 private:
  LockFile(std::string path, int fd, std::string former);

  std::string path_, former_;
  int fd_ = -1;
};

}  // namespace barchan
