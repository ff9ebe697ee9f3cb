#include <barchan/core/io/plain_text.hpp>

#include <algorithm>
#include <cstdint>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";
constexpr std::string_view kLittleEndianMark = "\xFF\xFE";
constexpr std::string_view kBigEndianMark = "\xFE\xFF";

[[noreturn]] void refuse(const std::string& file, const char* what) {
  throw InputError(SourcePlace{file, 0, 0}, what, "save it as UTF-8 text");
}

void put_utf8(std::uint32_t c, std::string& out) {
  const auto tail = [&](int shift) {
    out.push_back(static_cast<char>(0x80 | (c >> shift & 0x3f)));
  };
  if (c < 0x80) {
    out.push_back(static_cast<char>(c));
  } else if (c < 0x800) {
    out.push_back(static_cast<char>(0xc0 | c >> 6));
    tail(0);
  } else if (c < 0x10000) {
    out.push_back(static_cast<char>(0xe0 | c >> 12));
    tail(6);
    tail(0);
  } else {
    out.push_back(static_cast<char>(0xf0 | c >> 18));
    tail(12);
    tail(6);
    tail(0);
  }
}

std::string from_utf16(std::string_view bytes, bool is_little, const std::string& file) {
  if (bytes.size() % 2 != 0) refuse(file, "ends within a UTF-16 character");
  std::string out;
  out.reserve(bytes.size() / 2);
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(bytes[at]);
    const auto second = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<std::uint32_t>(is_little ? second << 8 | first : first << 8 | second);
  };
  for (std::size_t at = 0; at < bytes.size(); at += 2) {
    std::uint32_t c = unit(at);
    if (c >= 0xd800 && c < 0xe000) {
      const bool is_pair = c < 0xdc00 && at + 2 < bytes.size() && unit(at + 2) >> 10 == 0x37;
      if (!is_pair) refuse(file, "holds half of a UTF-16 character");
      at += 2;
      c = 0x10000 + ((c & 0x3ff) << 10 | (unit(at) & 0x3ff));
    }
    put_utf8(c, out);
  }
  return out;
}

}  // namespace

PlainText::PlainText(std::string_view text, const std::string& file) : view_(text) {
  const bool is_little = text.starts_with(kLittleEndianMark);
  if (is_little || text.starts_with(kBigEndianMark)) {
    converted_ = from_utf16(text.substr(2), is_little, file);
    view_ = converted_;
  } else if (text.starts_with(kUtf8Mark)) {
    view_.remove_prefix(kUtf8Mark.size());
  }
  if (view_.find('\0') != std::string_view::npos)
    refuse(file, "holds NUL bytes: it is binary, or UTF-16 without a mark at its beginning");
  if (view_.find('\n') != std::string_view::npos || view_.find('\r') == std::string_view::npos)
    return;
  if (converted_.empty()) converted_ = view_;
  std::replace(converted_.begin(), converted_.end(), '\r', '\n');
  view_ = converted_;
}

}  // namespace barchan
