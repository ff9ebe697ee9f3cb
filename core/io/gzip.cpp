#include <barchan/core/io/gzip.hpp>

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan {
namespace {

constexpr std::string_view kMagic = "\x1f\x8b";
constexpr int kGzipOnly = 16 + MAX_WBITS;
constexpr std::size_t kBlock = std::size_t{1} << 20;

[[noreturn]] void refuse(const std::string& file, const char* what, const char* remedy) {
  throw InputError(SourcePlace{file, 0, 0}, what, remedy);
}

/// zlib's state, and what is left of the input.
class Inflater {
 public:
  explicit Inflater(std::string_view bytes) : rest_(bytes) {
    if (inflateInit2(&stream_, kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Appends the content of one member. @return false where it is damaged or cut off
  bool read_member(std::string& out) {
    inflateReset(&stream_);
    int status = Z_OK;
    while (status == Z_OK) status = inflate_block(out);
    return status == Z_STREAM_END;
  }

  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  int inflate_block(std::string& out) {
    const std::size_t before = out.size();
    out.resize(before + kBlock);
    const auto most = std::min<std::size_t>(rest_.size(), std::numeric_limits<uInt>::max());
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest_.data()));
    stream_.avail_in = static_cast<uInt>(most);
    stream_.next_out = reinterpret_cast<Bytef*>(out.data() + before);
    stream_.avail_out = static_cast<uInt>(kBlock);
    const int status = inflate(&stream_, Z_NO_FLUSH);
    rest_.remove_prefix(most - stream_.avail_in);
    out.resize(before + kBlock - stream_.avail_out);
    return status;
  }

  std::string_view rest_;
  z_stream stream_{};
};

std::string inflate_all(std::string_view bytes, const std::string& file) {
  Inflater inflater(bytes);
  std::string text;
  do {
    if (!inflater.read_member(text))
      refuse(file, "is damaged or cut off: its gzip data do not end", "pack or copy it once more");
  } while (is_gzip(inflater.rest()));
  if (inflater.rest().find_first_not_of('\0') != std::string_view::npos)
    refuse(file, "something else follows its gzip data", "pack it once more");
  return text;
}

}  // namespace

bool is_gzip(std::string_view bytes) {
  return bytes.starts_with(kMagic);
}

std::string unzipped(std::string_view bytes, const std::string& file) {
  try {
    return inflate_all(bytes, file);
  } catch (const std::bad_alloc&) {
    refuse(file, "does not fit in memory once unpacked",
           "split it or use a machine with more memory");
  }
}

std::string read_unpacked_file(const std::string& path) {
  std::string text = read_text_file(path);
  if (!is_gzip(text)) return text;
  return unzipped(text, path);
}

}  // namespace barchan
