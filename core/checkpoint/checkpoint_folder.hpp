#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <barchan/core/checkpoint/manifest.hpp>

namespace barchan {

/// The folder of a run's checkpoints:
///
///     step_000000500/       complete: manifest.json, rank_00000.bin, rank_00001.bin, …
///     step_000001000.part/  being written, or left by a run that ended meanwhile
///     step_000000500.old/   the one of this step before, for the moment in which it is replaced
///
/// A checkpoint is complete or not there: its files are on the disk before its manifest, the
/// manifest before the folder gets its name. Errors of all that writes: FileError.
class CheckpointFolder {
 public:
  explicit CheckpointFolder(std::string path) : path_(std::move(path)) {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string complete(std::int64_t step) const;
  [[nodiscard]] std::string unfinished(std::int64_t step) const;

  /// Makes the folder of an unfinished one. Every rank may, at any time.
  void begin(std::int64_t step) const;
  /// All rank files are there: writes the manifest and gives the folder its name; replaces one of
  /// the same step. One rank.
  void commit(const Manifest& manifest) const;
  /// Removes an unfinished one that shall not be finished. One rank. Never throws.
  void discard(std::int64_t step) const noexcept;
  /// A run that ended while it replaced a checkpoint of the same step has left the former one under
  /// another name: gives it back its own. One rank, while nobody writes.
  void recover() const;
  /// Recovers, then removes all unfinished ones but those with other files in them. One rank, while
  /// nobody writes.
  void clean() const;
  /// After a commit at `step`: keeps the newest `keep`, and none of later steps, which an abandoned
  /// run left. One with other files in it stays. One rank.
  void prune(std::int64_t step, int keep) const;

  /// Whether an entry of the folder has the name of a checkpoint, complete or not.
  [[nodiscard]] static bool is_name(const std::string& name);
  /// A file in a checkpoint that is no part of it, or `checkpoint` itself when it is no folder;
  /// empty when there is none. Errors: filesystem_error.
  [[nodiscard]] static std::string foreign_file(const std::string& checkpoint);

  /// Steps of the complete ones, newest first; empty without a folder.
  [[nodiscard]] std::vector<std::int64_t> steps() const;

 private:
  std::string path_;
};

/// Reads the manifest in a checkpoint's folder. Errors: InputError.
[[nodiscard]] Manifest read_manifest(const std::string& checkpoint);

}  // namespace barchan
