#include <barchan/core/io/base64.hpp>

#include <array>
#include <cstdint>

namespace barchan {
namespace {

constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::int8_t kBlank = -2;
constexpr std::int8_t kBad = -1;

constexpr std::array<std::int8_t, 256> make_values() {
  std::array<std::int8_t, 256> values{};
  for (auto& value : values) value = kBad;
  for (int i = 0; i < 64; ++i)
    values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
  for (const unsigned char blank : {' ', '\t', '\r', '\n'}) values[blank] = kBlank;
  return values;
}

constexpr std::array<std::int8_t, 256> kValues = make_values();

void put_triple(const unsigned char* in, std::string& out) {
  const unsigned bits =
      static_cast<unsigned>(in[0]) << 16 | static_cast<unsigned>(in[1]) << 8 | in[2];
  const char digits[4] = {kDigits[bits >> 18], kDigits[bits >> 12 & 63], kDigits[bits >> 6 & 63],
                          kDigits[bits & 63]};
  out.append(digits, 4);
}

/// Removes the one or two = at the end; false when there are more.
bool strip_padding(std::string_view& text) {
  int num_padding = 0;
  while (!text.empty()) {
    const auto c = static_cast<unsigned char>(text.back());
    if (c == '=') ++num_padding;
    if (c != '=' && kValues[c] != kBlank) break;
    text.remove_suffix(1);
  }
  return num_padding <= 2;
}

}  // namespace

void Base64Encoder::add(std::string_view bytes, std::string& out) {
  const auto* in = reinterpret_cast<const unsigned char*>(bytes.data());
  const unsigned char* const end = in + bytes.size();
  while (num_carry_ > 0 && num_carry_ < 3 && in != end) carry_[num_carry_++] = *in++;
  if (num_carry_ == 3) {
    put_triple(carry_, out);
    num_carry_ = 0;
  }
  for (; end - in >= 3; in += 3) put_triple(in, out);
  while (in != end) carry_[num_carry_++] = *in++;
}

void Base64Encoder::finish(std::string& out) {
  if (num_carry_ == 0) return;
  for (int i = num_carry_; i < 3; ++i) carry_[i] = 0;
  put_triple(carry_, out);
  for (int i = num_carry_; i < 3; ++i) out[out.size() - 3 + static_cast<std::size_t>(i)] = '=';
  num_carry_ = 0;
}

std::optional<std::string> decode_base64(std::string_view text) {
  if (!strip_padding(text)) return std::nullopt;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int num_bits = 0;
  for (const char c : text) {
    const std::int8_t value = kValues[static_cast<unsigned char>(c)];
    if (value == kBlank) continue;
    if (value == kBad) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    num_bits += 6;
    if (num_bits < 8) continue;
    num_bits -= 8;
    bytes.push_back(static_cast<char>(bits >> num_bits & 0xff));
  }
  if (num_bits == 6) return std::nullopt;
  return bytes;
}

}  // namespace barchan
