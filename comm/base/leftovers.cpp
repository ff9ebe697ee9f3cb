#include <barchan/comm/base/leftovers.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/core/base/host_name.hpp>

namespace fs = std::filesystem;

namespace barchan {
namespace {

constexpr const char* kSharedMemory = "/dev/shm";
constexpr std::array<std::string_view, 4> kPrefixes{"vader_segment.", "sm_segment.", "osc_rdma.",
                                                    "osc_sm."};
// [s], in whole seconds; between making a file and mapping it passes far less.
constexpr std::time_t kOld = 2;

std::string short_host() {
  const std::string host = host_name();
  return host.substr(0, host.find('.'));
}

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

/// Of this user, and at least so many seconds old.
bool is_mine(const fs::path& path, std::time_t age) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && status.st_uid == ::geteuid() &&
         std::time(nullptr) - status.st_ctime >= age;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code ignored;
  for (fs::directory_iterator it(folder, ignored), end; it != end; it.increment(ignored))
    entries.push_back(it->path());
  return entries;
}

std::vector<fs::path> segments() {
  std::vector<fs::path> found;
  for (const fs::path& path : entries_of(kSharedMemory)) {
    const std::string name = path.filename().string();
    const bool is_segment = std::any_of(kPrefixes.begin(), kPrefixes.end(), [&](auto prefix) {
      return name.starts_with(std::string(prefix) + short_host() + ".");
    });
    if (is_segment && is_mine(path, kOld)) found.push_back(path);
  }
  return found;
}

fs::path temporary_base() {
  for (const char* variable : {"OMPI_MCA_orte_tmpdir_base", "TMPDIR", "TEMP", "TMP"}) {
    if (const char* folder = std::getenv(variable)) return folder;
  }
  return "/tmp";
}

bool is_dead(const std::string& pid) {
  return ::kill(static_cast<pid_t>(std::atol(pid.c_str())), 0) != 0 && errno == ESRCH;
}

/// Of launchers that have died.
std::vector<fs::path> sessions() {
  std::vector<fs::path> found;
  for (const fs::path& base : entries_of(temporary_base())) {
    const std::string name = base.filename().string();
    const bool is_base = name.starts_with("ompi." + short_host()) &&
                         name.ends_with("." + std::to_string(::geteuid()));
    if (!is_base || !is_mine(base, 0)) continue;
    for (const fs::path& path : entries_of(base)) {
      const std::string session = path.filename().string();
      if (!session.starts_with("pid.") || !is_number(session.substr(4))) continue;
      if (is_dead(session.substr(4)) && is_mine(path, kOld)) found.push_back(path);
    }
  }
  return found;
}

/// The files that processes map. Those that cannot be looked at are not ranks of this user.
std::set<std::string> mapped_files() {
  std::set<std::string> mapped;
  for (const fs::path& process : entries_of("/proc")) {
    if (!is_number(process.filename().string())) continue;
    std::ifstream maps(process / "maps");
    std::string line;
    while (std::getline(maps, line)) {
      const auto path = line.find('/');
      if (path != std::string::npos) mapped.insert(line.substr(path));
    }
  }
  return mapped;
}

bool is_in_use(const std::string& path, const std::set<std::string>& mapped) {
  const auto it = mapped.lower_bound(path);
  return it != mapped.end() && (*it == path || it->starts_with(path + "/"));
}

int remove_dead() {
  std::vector<fs::path> found = segments();
  const std::vector<fs::path> folders = sessions();
  found.insert(found.end(), folders.begin(), folders.end());
  if (found.empty()) return 0;
  const std::set<std::string> mapped = mapped_files();
  int count = 0;
  std::error_code ignored;
  for (const fs::path& path : found) {
    if (is_in_use(path.string(), mapped)) continue;
    count += fs::remove_all(path, ignored) > 0 && !ignored ? 1 : 0;
  }
  return count;
}

}  // namespace

int remove_leftovers() noexcept {
  try {
    return remove_dead();
  } catch (const std::exception&) {  // what cannot be looked at stays
    return 0;
  }
}

}  // namespace barchan
