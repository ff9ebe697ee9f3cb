#include <barchan/core/checkpoint/durable.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

namespace barchan {
namespace {

constexpr std::size_t kMostAtOnce = std::size_t{1}
                                    << 26;  // 64 MiB: Linux writes no more than 2 GiB in a call

/// Closes on every way out.
class Descriptor {
 public:
  Descriptor(const std::string& path, int flags, const char* verb)
      : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (fd_ < 0) throw FileError(verb, path, errno);
  }
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int get() const { return fd_; }
  /// Some file systems tell of a full disk only here. @return errno, 0 when all went well
  int close() {
    const int status = ::close(std::exchange(fd_, -1));
    return status == 0 ? 0 : errno;
  }

 private:
  int fd_;
};

void write_all(int fd, std::span<const std::byte> bytes, const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), std::min(bytes.size(), kMostAtOnce));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw FileError("write", path, errno);
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
}

}  // namespace

FileError::FileError(const std::string& verb, const std::string& path, int code)
    : RunError("cannot " + verb + " " + path + ": " + std::strerror(code)), code_(code) {}

void write_durably(const std::string& path, std::span<const std::span<const std::byte>> parts) {
  Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC, "create");
  try {
    for (const auto& part : parts) write_all(file.get(), part, path);
    if (::fsync(file.get()) != 0) throw FileError("write", path, errno);
    if (const int code = file.close(); code != 0) throw FileError("write", path, code);
  } catch (...) {
    ::unlink(path.c_str());
    throw;
  }
}

void sync_folder(const std::string& path) {
  const Descriptor folder(path, O_RDONLY | O_DIRECTORY, "open");
  // Some network file systems do not know fsync of a folder; there is no more to be done there.
  if (::fsync(folder.get()) != 0 && errno != EINVAL && errno != ENOTSUP)
    throw FileError("write", path, errno);
}

void rename_durably(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) throw FileError("rename", from, errno);
  sync_folder(std::filesystem::path(to).parent_path().string());
}

}  // namespace barchan
