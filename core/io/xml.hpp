#pragma once

#include <array>
#include <string>
#include <string_view>

#include <barchan/core/base/error.hpp>

namespace barchan {

/// One tag of an XML text, or the text between two.
struct XmlToken {
  enum class Kind { Open, Close, Empty, Text, End } kind = Kind::End;
  std::string_view name;        ///< of the tag
  std::string_view attributes;  ///< of the tag, as written
  std::string_view text;        ///< between tags, as written

  /// Value of an attribute as written, empty when absent.
  [[nodiscard]] std::string_view attribute(std::string_view key) const;
};

/// Walks over the XML that barchan writes: tags, attributes in double quotes, text; comments and
/// declarations are passed over; no entities, no CDATA. Checks that tags are properly nested.
class XmlReader {
 public:
  XmlReader(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  /// @throws InputError at the line of what is malformed
  [[nodiscard]] XmlToken next();

  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;

 private:
  static constexpr std::size_t kDeepest = 32;

  XmlToken tag(std::string_view body);
  void skip_declarations();

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  std::array<std::string_view, kDeepest> open_{};
  std::size_t depth_ = 0;
};

/// The text with &, <, > and " as entities, for attributes.
[[nodiscard]] std::string escape_xml(std::string_view text);
[[nodiscard]] std::string unescape_xml(std::string_view text);

}  // namespace barchan
