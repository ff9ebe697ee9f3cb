#include <barchan/tasks/results/own_files.hpp>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/checkpoint/checkpoint_folder.hpp>

namespace fs = std::filesystem;

namespace barchan {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kHead = 4096;  // bytes of a file that are looked at

/// How a file of this name begins when barchan wrote it.
struct Result {
  std::string_view name, beginning;
};
constexpr std::array<Result, 8> kResults{
    {{"run.json", "{\n"},
     {"series.csv", "step,time,kinetic_energy,contacts,max_overlap"},
     {"picture.png", "\x89PNG\r\n\x1a\n"},
     {"trace.json", "{\"displayTimeUnit\":\"ns\",\"traceEvents\":["},
     {"log.txt", "barchan "},
     {"progress.json", "{\"step\":"},
     {"report.html", "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"},
     {"left_domain.csv", "step,id,x,y"}}};
constexpr std::string_view kVtk = "<?xml version=\"1.0\"?>\n<VTKFile type=\"";
/// What else is near the beginning.
constexpr std::array<Result, 4> kMarks{{{"run.json", "\"state_digest\""},
                                        {"picture.png", "tEXtSoftware\0barchan"sv},
                                        {"log.txt", ": from step "},
                                        {"report.html", "content=\"barchan report\""}}};

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw InputError(SourcePlace{path.string(), 0, 0}, why,
                   "move it away, or give another output folder; nothing was removed");
}

std::string head_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(kHead, '\0');
  file.read(head.data(), static_cast<std::streamsize>(kHead));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return head;
}

/// Files that were cut short, by a full disk say, are ours as far as they go.
bool agrees(std::string_view text, std::string_view beginning) {
  const std::size_t length = std::min(text.size(), beginning.size());
  return text.substr(0, length) == beginning.substr(0, length);
}

/// `series_1.csv`: rows with other columns, kept at a restart.
bool is_former_series(std::string_view name) {
  constexpr std::string_view prefix = "series_", suffix = ".csv";
  if (!name.starts_with(prefix) || !name.ends_with(suffix)) return false;
  const auto number = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
  return !number.empty() && number.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Of a result that was being written when its run ended: `run.json.tmp4242`.
std::string_view without_temporary(std::string_view name) {
  const std::size_t at = name.rfind(".tmp");
  const bool is_temporary = at != std::string_view::npos && at + 4 < name.size() &&
                            name.find_first_not_of("0123456789", at + 4) == std::string_view::npos;
  return is_temporary ? name.substr(0, at) : name;
}

class Finder {
 public:
  explicit Finder(fs::path root) : root_(std::move(root)) {}

  OwnFiles find() {
    for_each_in(root_, [&](const fs::path& path) { add_result(path); });
    for_each_in(root_ / "snapshots", [&](const fs::path& path) { add_snapshot(path); });
    for_each_in(root_ / "checkpoints", [&](const fs::path& path) { add_checkpoint(path); });
    return std::move(own_);
  }

 private:
  template <class Visit>
  static void for_each_in(const fs::path& folder, Visit&& visit) {
    const fs::file_status status = fs::status(folder);
    if (!fs::exists(status)) return;
    if (!fs::is_directory(status)) refuse(folder, "has the name of a run's folder, and is none");
    for (const auto& entry : fs::directory_iterator(folder)) visit(entry.path());
  }

  void add(const fs::path& path) {
    if (::access(path.parent_path().c_str(), W_OK | X_OK) != 0)
      refuse(path, std::string("cannot be removed: ") + std::strerror(errno));
    own_.files.push_back(path);
  }

  /// @param is_whole  its name is its last one
  static bool is_ours(const fs::path& path, std::string_view name, bool is_whole) {
    if (!fs::is_regular_file(path)) return false;
    const std::string head = head_of(path);
    for (const Result& result : kResults) {
      const bool has_name =
          name == result.name || (result.name == "series.csv" && is_former_series(name));
      if (has_name && !agrees(head, result.beginning)) return false;
    }
    for (const Result& mark : kMarks) {
      const bool must_have = is_whole && !head.empty() && name == mark.name;
      if (must_have && head.find(mark.beginning) == std::string::npos) return false;
    }
    return true;
  }

  void add_result(const fs::path& path) {
    const std::string full = path.filename().string();
    const std::string_view name = without_temporary(full);
    const bool has_name = is_former_series(name) ||
                          std::any_of(kResults.begin(), kResults.end(),
                                      [&](const Result& result) { return result.name == name; });
    if (!has_name) return;
    if (!is_ours(path, name, name == full))
      refuse(path, "has the name of a result, but no run wrote it");
    add(path);
  }

  void add_snapshot(const fs::path& path) {
    const std::string full = path.filename().string();
    const std::string name(without_temporary(full));
    if (name != "run.pvd" && !snapshot_step(name)) return;
    if (!fs::is_regular_file(path) || !agrees(head_of(path), kVtk))
      refuse(path, "has the name of a snapshot, but no run wrote it");
    add(path);
  }

  void add_checkpoint(const fs::path& path) {
    if (!CheckpointFolder::is_name(path.filename().string())) return;
    const std::string foreign = CheckpointFolder::foreign_file(path.string());
    if (!foreign.empty()) refuse(foreign, "is no part of a checkpoint, and no run wrote it");
    for (const auto& entry : fs::directory_iterator(path)) add(entry.path());
    add(path);
    own_.files.pop_back();
    own_.folders.push_back(path);
  }

  fs::path root_;
  OwnFiles own_;
};

}  // namespace

OwnFiles find_own_files(const std::string& folder) {
  return Finder(folder).find();
}

void remove_files(const OwnFiles& own) {
  for (const fs::path& path : own.files) fs::remove(path);
  for (const fs::path& path : own.folders) fs::remove(path);
}

std::optional<std::int64_t> snapshot_step(const std::string& file) {
  std::int64_t step = -1;
  if (!file.starts_with("step_")) return std::nullopt;
  std::string name = file;
  constexpr std::string_view bonds = "_bonds";
  if (const auto at = name.rfind(bonds); at != std::string::npos) name.erase(at, bonds.size());
  const char* end = name.data() + name.size();
  const auto number = std::from_chars(name.data() + 5, end, step);
  if (number.ec != std::errc{} || step < 0) return std::nullopt;
  if (name == fmt::format("step_{:09}.pvtp", step)) return step;
  const std::string_view rest(number.ptr, static_cast<std::size_t>(end - number.ptr));
  constexpr std::string_view prefix = "_rank_";
  std::int64_t rank = -1;
  if (!rest.starts_with(prefix)) return std::nullopt;
  (void)std::from_chars(rest.data() + prefix.size(), end, rank);
  if (name == fmt::format("step_{:09}_rank_{}.vtp", step, rank)) return step;
  return std::nullopt;
}

}  // namespace barchan
