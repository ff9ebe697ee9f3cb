#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <barchan/core/base/error.hpp>

// Files that are on the disk when a function returns, not only on their way to it.

namespace barchan {

/// A file operation failed. `code` is its errno, so that a rank may tell another one in a number.
class FileError : public RunError {
 public:
  FileError(const std::string& verb, const std::string& path, int code);
  [[nodiscard]] int code() const { return code_; }

 private:
  int code_;
};

/// Writes the parts one after the other into a new file, and waits for the disk. What was under
/// that name is replaced; after an error nothing is left under it. Errors: FileError.
void write_durably(const std::string& path, std::span<const std::span<const std::byte>> parts);

/// Waits until the names in a folder are on the disk. Errors: FileError.
void sync_folder(const std::string& path);

/// Gives a file or folder another name in the same folder, on the disk too. Errors: FileError.
void rename_durably(const std::string& from, const std::string& to);

}  // namespace barchan
