#pragma once

#include <string>
#include <string_view>

namespace barchan {

/// A text as readers of tables take it: UTF-8 without mark, lines that end in a line feed. UTF-16
/// with a mark and the lone carriage returns of old Macs are converted; nothing else is copied.
class PlainText {
 public:
  /// @param text  outlives this object. @throws InputError naming `file`: binary data, half of a
  /// UTF-16 character
  PlainText(std::string_view text, const std::string& file);
  PlainText(const PlainText&) = delete;
  PlainText& operator=(const PlainText&) = delete;

  [[nodiscard]] std::string_view view() const { return view_; }

 private:
  std::string converted_;
  std::string_view view_;
};

}  // namespace barchan
