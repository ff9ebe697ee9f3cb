#include <barchan/core/checkpoint/checkpoint_folder.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include <fmt/format.h>

#include <barchan/core/checkpoint/durable.hpp>

namespace fs = std::filesystem;

namespace barchan {
namespace {

constexpr std::string_view kPrefix = "step_";
constexpr std::string_view kPart = ".part", kOld = ".old";
constexpr std::uint64_t kLargestManifest = std::uint64_t{1} << 28;

/// The step in the name of a complete checkpoint; -1 for all other names.
std::int64_t step_of(const std::string& name) {
  std::int64_t step = -1;
  if (!name.starts_with(kPrefix)) return step;
  (void)std::from_chars(name.data() + kPrefix.size(), name.data() + name.size(), step);
  return name == fmt::format("{}{:09}", kPrefix, step) ? step : -1;
}

bool is_unfinished(const fs::path& path) {
  const std::string ending = path.extension().string();
  return (ending == kPart || ending == kOld) && step_of(path.stem().string()) >= 0;
}

/// `rank_00000.bin`, of any rank.
bool is_rank_file(const std::string& name) {
  std::size_t rank = 0;
  constexpr std::string_view prefix = "rank_";
  if (!name.starts_with(prefix)) return false;
  (void)std::from_chars(name.data() + prefix.size(), name.data() + name.size(), rank);
  return name == rank_file_name(rank);
}

/// Removes a checkpoint, unless there are other files in it.
void remove_checkpoint(const fs::path& path) {
  if (!fs::exists(path) || !CheckpointFolder::foreign_file(path.string()).empty()) return;
  fs::remove_all(path);
}

std::vector<fs::path> unfinished_in(const std::string& folder) {
  std::vector<fs::path> found;
  if (!fs::is_directory(folder)) return found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (is_unfinished(entry.path())) found.push_back(entry.path());
  }
  return found;
}

/// The folder of checkpoints may be as new as what lies in it, and so may the run's folder. Where
/// those above cannot be read there is no more to be done.
void sync_names_of(const std::string& folder) {
  fs::path above = fs::absolute(folder).lexically_normal();
  for (int level = 0; level < 2; ++level) {
    above = above.parent_path();
    try {
      sync_folder(above.string());
    } catch (const FileError&) {
    }
  }
}

template <class Work>
void or_file_error(const char* verb, const std::string& path, Work&& work) {
  try {
    work();
  } catch (const fs::filesystem_error& e) {
    throw FileError(verb, path, e.code().value());
  }
}

}  // namespace

std::string CheckpointFolder::complete(std::int64_t step) const {
  return fmt::format("{}/step_{:09}", path_, step);
}

std::string CheckpointFolder::unfinished(std::int64_t step) const {
  return complete(step) + std::string(kPart);
}

void CheckpointFolder::begin(std::int64_t step) const {
  or_file_error("make", unfinished(step), [&] { fs::create_directories(unfinished(step)); });
}

void CheckpointFolder::commit(const Manifest& manifest) const {
  const std::string from = unfinished(manifest.step), to = complete(manifest.step),
                    old = to + std::string(kOld);
  const std::string text = manifest_text(manifest);
  const auto bytes = std::as_bytes(std::span(text));
  write_durably(from + "/" + kManifestName, std::span(&bytes, 1));
  sync_folder(from);
  or_file_error("replace", to, [&] {
    if (!fs::exists(to)) return;
    remove_checkpoint(old);
    fs::rename(to, old);
  });
  rename_durably(from, to);
  sync_names_of(path_);
  try {
    remove_checkpoint(old);
  } catch (const fs::filesystem_error&) {  // the new one is complete all the same
  }
}

void CheckpointFolder::discard(std::int64_t step) const noexcept {
  try {
    remove_checkpoint(unfinished(step));
  } catch (const std::exception&) {  // the next run removes it
  }
}

void CheckpointFolder::recover() const {
  or_file_error("recover", path_, [&] {
    for (const fs::path& path : unfinished_in(path_)) {
      const fs::path whole = fs::path(path).replace_extension();
      if (path.extension() == kOld && !fs::exists(whole)) fs::rename(path, whole);
    }
  });
}

void CheckpointFolder::clean() const {
  recover();
  or_file_error("clean", path_, [&] {
    for (const fs::path& path : unfinished_in(path_)) remove_checkpoint(path);
  });
}

void CheckpointFolder::prune(std::int64_t step, int keep) const {
  or_file_error("remove old checkpoints in", path_, [&] {
    int kept = 0;
    for (const std::int64_t s : steps()) {
      if (s > step || ++kept > keep) remove_checkpoint(complete(s));
    }
  });
}

bool CheckpointFolder::is_name(const std::string& name) {
  return step_of(name) >= 0 || is_unfinished(name);
}

std::string CheckpointFolder::foreign_file(const std::string& checkpoint) {
  if (!fs::is_directory(checkpoint)) return checkpoint;
  for (const auto& entry : fs::directory_iterator(checkpoint)) {
    const std::string name = entry.path().filename().string();
    const bool is_part = name == kManifestName || is_rank_file(name);
    if (!is_part || !fs::is_regular_file(entry.path())) return entry.path().string();
  }
  return {};
}

std::vector<std::int64_t> CheckpointFolder::steps() const {
  std::vector<std::int64_t> steps;
  or_file_error("list", path_, [&] {
    if (!fs::is_directory(path_)) return;
    for (const auto& entry : fs::directory_iterator(path_)) {
      if (const std::int64_t step = step_of(entry.path().filename().string());
          step >= 0 && entry.is_directory())
        steps.push_back(step);
    }
  });
  std::sort(steps.rbegin(), steps.rend());
  return steps;
}

Manifest read_manifest(const std::string& checkpoint) {
  const std::string path = checkpoint + "/" + kManifestName;
  const auto bytes = read_bytes(path, kLargestManifest);
  return parse_manifest(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
                        path);
}

}  // namespace barchan
