#include <barchan/core/io/lock_file.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <barchan/core/base/host_name.hpp>
#include <barchan/core/checkpoint/durable.hpp>

namespace barchan {
namespace {

struct Holder {
  std::string host, since;
  long pid = 0;
  std::string started;

  [[nodiscard]] bool is_known() const { return pid > 0 && !host.empty(); }
};

/// Field 22 of /proc/PID/stat; empty when there is no such process.
std::string start_of(long pid) {
  std::ifstream file(fmt::format("/proc/{}/stat", pid));
  std::string text;
  std::getline(file, text);
  const auto name_end = text.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream words(text.substr(name_end + 1));
  std::string word;
  for (int field = 3; field <= 22; ++field) words >> word;
  return word;
}

Holder read_holder(int fd) {
  char text[1024] = {};
  const ssize_t length = ::pread(fd, text, sizeof text - 1, 0);
  Holder holder;
  std::istringstream lines(std::string(text, length > 0 ? static_cast<std::size_t>(length) : 0));
  std::string key;
  while (lines >> key) {
    if (key == "host") lines >> holder.host;
    if (key == "pid") lines >> holder.pid;
    if (key == "started") lines >> holder.started;
    if (key == "since") std::getline(lines >> std::ws, holder.since);
  }
  return holder;
}

std::string describe(const Holder& holder) {
  if (!holder.is_known()) return "a process that has just begun";
  return fmt::format("process {} on {} since {}", holder.pid, holder.host, holder.since);
}

/// For file systems without locks. Of a process on another host nothing is known, so it may live.
bool may_live(const Holder& holder) {
  if (!holder.is_known() || holder.host != host_name()) return true;
  return start_of(holder.pid) == holder.started;
}

/// 0, or errno. A file system without locks: EOPNOTSUPP or the like.
int lock(int fd) {
  while (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EINTR) return errno;
  }
  return 0;
}

bool is_at(const std::string& path, int fd) {
  struct stat named {
  }, opened{};
  return ::stat(path.c_str(), &named) == 0 && ::fstat(fd, &opened) == 0 &&
         named.st_ino == opened.st_ino && named.st_dev == opened.st_dev;
}

void write_holder(const std::string& path, int fd) {
  const auto now =
      std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  const std::string text =
      fmt::format("host {}\npid {}\nstarted {}\nsince {:%Y-%m-%d %H:%M:%S} UTC\n", host_name(),
                  ::getpid(), start_of(::getpid()), now);
  const bool is_written = ::ftruncate(fd, 0) == 0 && ::pwrite(fd, text.data(), text.size(), 0) ==
                                                         static_cast<ssize_t>(text.size());
  if (!is_written) throw FileError("write", path, errno);
}

}  // namespace

LockFile::LockFile(std::string path, int fd, std::string former)
    : path_(std::move(path)), former_(std::move(former)), fd_(fd) {}

LockFile::LockFile(LockFile&& other) noexcept
    : path_(std::move(other.path_)),
      former_(std::move(other.former_)),
      fd_(std::exchange(other.fd_, -1)) {}

LockFile::~LockFile() {
  if (fd_ < 0) return;
  if (is_at(path_, fd_)) ::unlink(path_.c_str());
  ::close(fd_);
}

std::optional<LockFile> LockFile::acquire(const std::string& path, std::string& holder) {
  for (;;) {
    bool is_new = true;
    int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (fd < 0 && errno == EEXIST) {
      is_new = false;
      fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
      if (fd < 0 && errno == ENOENT) continue;  // given back meanwhile
    }
    if (fd < 0) throw FileError("make", path, errno);
    const Holder found = read_holder(fd);
    const int code = lock(fd);
    const bool knows_locks = code == 0 || code == EWOULDBLOCK;
    if (code == EWOULDBLOCK || (!knows_locks && !is_new && may_live(found))) {
      holder = describe(found);
      ::close(fd);
      return std::nullopt;
    }
    if (is_at(path, fd)) {
      LockFile mine(path, fd, is_new || !found.is_known() ? "" : describe(found));
      write_holder(path, fd);
      return mine;
    }
    ::close(fd);  // its holder removed it between open and lock
  }
}

}  // namespace barchan
