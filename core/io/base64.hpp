#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace barchan {

/// Encodes bytes that arrive in parts as one base64 text (RFC 4648, padded).
class Base64Encoder {
 public:
  void add(std::string_view bytes, std::string& out);
  void finish(std::string& out);

 private:
  unsigned char carry_[3] = {};
  int num_carry_ = 0;
};

/// The bytes of a base64 text, blanks ignored; none when it is malformed.
[[nodiscard]] std::optional<std::string> decode_base64(std::string_view text);

}  // namespace barchan
