#include <barchan/tasks/results/run_folder.hpp>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <barchan/core/base/error.hpp>

namespace fs = std::filesystem;

namespace barchan {
namespace {

constexpr const char* kElsewhere = "give another output folder";

[[noreturn]] void refuse(const std::string& path, const std::string& why,
                         const std::string& remedy) {
  throw InputError(SourcePlace{path, 0, 0}, why, remedy);
}

void check_writable(const fs::path& folder, const std::string& wanted) {
  if (::access(folder.c_str(), W_OK | X_OK) == 0) return;
  refuse(wanted, "cannot write to " + folder.string() + ": " + std::strerror(errno), kElsewhere);
}

/// The folder that a new one would be made in.
fs::path nearest_existing(const fs::path& path) {
  fs::path parent = fs::absolute(path).lexically_normal();
  std::error_code ignored;
  while (parent.has_relative_path() && !fs::exists(parent, ignored)) parent = parent.parent_path();
  return parent;
}

/// Nothing in it but the lock of a run that has just begun, or died before it did.
bool is_empty(const std::string& folder) {
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(),
                     [](const auto& entry) { return entry.path().filename() == kLockName; });
}

}  // namespace

RunFolder RunFolder::of_deck(const std::string& deck_path) {
  return RunFolder(fs::path(deck_path).stem().string() + ".out");
}

void RunFolder::check(bool may_replace) const {
  if (path_.empty()) throw InputError("the output folder has no name", kElsewhere);
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (status.type() == fs::file_type::directory) {
    check_writable(path_, path_);
    if (may_replace)
      (void)own_files();
    else if (!is_empty(path_))
      refuse(path_, "the output folder already exists",
             "give another one, or --force to replace its results");
    return;
  }
  if (fs::exists(status)) refuse(path_, "the output folder is a file", kElsewhere);
  const fs::path parent = nearest_existing(path_);
  if (!fs::is_directory(parent, error))
    refuse(path_, "cannot make this folder: " + parent.string() + " is a file", kElsewhere);
  check_writable(parent, path_);
}

OwnFiles RunFolder::own_files() const {
  try {
    return find_own_files(path_);
  } catch (const fs::filesystem_error& e) {
    refuse(path_, "cannot read the output folder: " + e.code().message(), kElsewhere);
  }
}

void RunFolder::begin() const {
  const OwnFiles own = own_files();
  try {
    fs::create_directories(path_ + "/snapshots");
    remove_files(own);
    std::error_code ignored;
    fs::remove(path_ + "/checkpoints", ignored);  // where it is empty now
  } catch (const fs::filesystem_error& e) {
    refuse(path_, "cannot prepare the output folder: " + e.code().message(), kElsewhere);
  }
}

void RunFolder::resume() const {
  (void)own_files();
  try {
    fs::create_directories(path_ + "/snapshots");
  } catch (const fs::filesystem_error& e) {
    refuse(path_, "cannot go on in the output folder: " + e.code().message(), kElsewhere);
  }
}

void RunFolder::reopen() const {
  try {
    fs::remove(path_ + "/run.json");  // is there only once a run has ended
  } catch (const fs::filesystem_error& e) {
    refuse(path_, "cannot continue in the output folder: " + e.code().message(), kElsewhere);
  }
}

}  // namespace barchan
