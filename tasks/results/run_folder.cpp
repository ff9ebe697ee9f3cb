#include <barchan/tasks/results/run_folder.hpp>

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <barchan/core/error.hpp>

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

bool is_snapshot(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".vtp" || ending == ".pvtp" || ending == ".pvd";
}

void remove_results(const std::string& path) {
  for (const char* name :
       {"run.json", "series.csv", "picture.png", "trace.json", "log.txt", "left_domain.csv"})
    fs::remove(path + "/" + name);
  fs::remove_all(path + "/checkpoints");
  const fs::path snapshots = path + "/snapshots";
  if (!fs::is_directory(snapshots)) return;
  for (const auto& entry : fs::directory_iterator(snapshots)) {
    if (is_snapshot(entry.path())) fs::remove(entry.path());
  }
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
    if (!may_replace)
      refuse(path_, "the output folder already exists",
             "give another one, or --force to replace its results");
    return check_writable(path_, path_);
  }
  if (fs::exists(status)) refuse(path_, "the output folder is a file", kElsewhere);
  const fs::path parent = nearest_existing(path_);
  if (!fs::is_directory(parent, error))
    refuse(path_, "cannot make this folder: " + parent.string() + " is a file", kElsewhere);
  check_writable(parent, path_);
}

void RunFolder::begin() const {
  try {
    fs::create_directories(path_ + "/snapshots");
    remove_results(path_);
  } catch (const fs::filesystem_error& e) {
    refuse(path_, "cannot prepare the output folder: " + e.code().message(), kElsewhere);
  }
}

void RunFolder::resume() const {
  try {
    fs::create_directories(path_ + "/snapshots");
    fs::remove(path_ + "/run.json");  // is there only once a run has ended
  } catch (const fs::filesystem_error& e) {
    refuse(path_, "cannot continue in the output folder: " + e.code().message(), kElsewhere);
  }
}

}  // namespace barchan
