#include <filesystem>

#include <barchan/core/base/error.hpp>
#include <barchan/core/checkpoint/checkpoint_folder.hpp>
#include <barchan/core/checkpoint/durable.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/checkpoint_load.hpp>
#include <barchan/tasks/checkpoint_read.hpp>

namespace fs = std::filesystem;

namespace barchan {
namespace {

/// Reads every byte: each rank some of the files.
std::int64_t verify(const Communicator& communicator, const std::string& path) {
  const Manifest manifest = read_shared_manifest(communicator, path);
  agree(communicator, [&] {
    const auto first = static_cast<std::size_t>(communicator.rank()),
               stride = static_cast<std::size_t>(communicator.size());
    for (std::size_t r = first; r < manifest.files.size(); r += stride)
      (void)RankFile(path, manifest, r);
  });
  return manifest.step;
}

/// The candidates in `path`, newest first; the first line tells whether one was named.
std::vector<std::string> candidates(const std::string& path, bool& is_named) {
  const fs::path given =
      fs::path(path).filename() == kManifestName ? fs::path(path).parent_path() : fs::path(path);
  std::error_code ignored;
  is_named = fs::exists(given / kManifestName, ignored);
  if (is_named) return {given.string()};
  const fs::path inner = given / "checkpoints";
  const CheckpointFolder folder(fs::is_directory(inner, ignored) ? inner.string() : given.string());
  try {
    folder.recover();
  } catch (const FileError&) {  // in a folder that only can be read the others have to do
  }
  std::vector<std::string> found;
  for (const std::int64_t step : folder.steps()) found.push_back(folder.complete(step));
  return found;
}

/// One text for all: "named" or "found", then a path a line.
std::vector<std::string> shared_candidates(const Communicator& communicator,
                                           const std::string& path, bool& is_named) {
  std::string text;
  agree(communicator, [&] {
    if (!communicator.is_root()) return;
    const auto found = candidates(path, is_named);
    text = is_named ? "named\n" : "found\n";
    for (const std::string& candidate : found) text += candidate + "\n";
  });
  text = communicator.bcast(text);
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  is_named = lines.front() == "named";
  lines.erase(lines.begin());
  return lines;
}

}  // namespace

std::optional<CheckpointChoice> find_checkpoint(const Communicator& communicator,
                                                const std::string& path) {
  bool is_named = false;
  const std::vector<std::string> found = shared_candidates(communicator, path, is_named);
  CheckpointChoice choice;
  for (const std::string& candidate : found) {
    try {
      choice.step = verify(communicator, candidate);
      choice.path = candidate;
      return choice;
    } catch (const InputError& e) {
      if (is_named) throw;
      choice.skipped.emplace_back(e.what());
    }
  }
  if (found.empty()) return std::nullopt;
  std::string reasons;
  for (const std::string& reason : choice.skipped) reasons += "\n  " + reason;
  throw InputError(SourcePlace{path, 0, 0}, "none of the checkpoints can be used:" + reasons,
                   "to start the run from step 0, leave --restart out and give --force or another "
                   "--out");
}

}  // namespace barchan
