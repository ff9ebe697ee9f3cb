#include <barchan/tasks/results/folder_claim.hpp>

#include <algorithm>
#include <filesystem>

#include <barchan/core/base/error.hpp>
#include <barchan/core/checkpoint/durable.hpp>

namespace fs = std::filesystem;

namespace barchan {

FolderClaim::FolderClaim(const RunFolder& folder, bool may_exist) {
  // Whoever holds the folder changes it, so where there is a lock, nothing is looked at before it
  // is ours. Without one nobody holds a folder that is refused anyway.
  std::error_code ignored;
  if (!fs::exists(folder.file(kLockName), ignored)) folder.check(may_exist);
  try {
    make_folders(folder.path());
    lock(folder);
    folder.check(may_exist);
  } catch (...) {
    lock_.reset();
    remove_empty();
    throw;
  }
}

FolderClaim::~FolderClaim() {
  lock_.reset();
  remove_empty();
}

void FolderClaim::make_folders(const std::string& path) {
  std::vector<fs::path> missing;
  fs::path at = fs::absolute(path).lexically_normal();
  if (!at.has_filename()) at = at.parent_path();
  for (; !fs::exists(at); at = at.parent_path()) missing.push_back(at);
  std::reverse(missing.begin(), missing.end());
  try {
    for (const fs::path& folder : missing) {
      if (fs::create_directory(folder)) made_.push_back(folder.string());
    }
  } catch (const fs::filesystem_error& e) {
    throw InputError(SourcePlace{path, 0, 0}, "cannot make this folder: " + e.code().message(),
                     "give another output folder");
  }
}

void FolderClaim::lock(const RunFolder& folder) {
  std::string holder;
  try {
    auto lock = LockFile::acquire(folder.file(kLockName), holder);
    if (lock) lock_.emplace(std::move(*lock));
  } catch (const FileError& e) {
    throw InputError(SourcePlace{folder.path(), 0, 0}, e.what(), "give another output folder");
  }
  if (lock_) return;
  throw InputError(SourcePlace{folder.path(), 0, 0},
                   "another run is writing into this folder: " + holder,
                   "wait for its end, or give another output folder");
}

void FolderClaim::remove_empty() noexcept {
  std::error_code ignored;
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) fs::remove(*folder, ignored);
}

}  // namespace barchan
