#include <barchan/core/deck/text_check.hpp>

#include <algorithm>
#include <cstddef>

#include <barchan/core/base/error.hpp>

namespace barchan::deck {

namespace {

constexpr int kMaxDots = 15;

bool is_ascii(char c) {
  return static_cast<unsigned char>(c) < 0x80;
}

/// Walks over the text once; strings and comments are passed over whole.
class TextCheck {
 public:
  TextCheck(std::string_view text, const std::string& file_name)
      : text_(text), file_name_(file_name) {}

  void run() {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.substr(0, 3) == kByteOrderMark) at_ = 3;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_string(c);
      } else if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else {
        check_letter(c);
        ++at_;
      }
    }
  }

 private:
  void check_letter(char c) {
    if (!is_ascii(c))
      fail("a letter beyond ASCII outside a string", "put the word in double quotes");
    if (c == '.' && ++num_dots_ > kMaxDots) {
      fail("a dotted key of more than 16 parts", "no key of a deck has more than 3");
    }
    if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos) num_dots_ = 0;
  }

  void skip_string(char quote) {
    const bool is_long = text_.substr(at_, 3) == std::string(3, quote);
    if (is_long) {
      skip_long_string(quote);
      return;
    }
    ++at_;
    while (at_ < text_.size() && text_[at_] != quote && text_[at_] != '\n') step(quote);
    if (at_ < text_.size() && text_[at_] == quote) ++at_;
  }

  void skip_long_string(char quote) {
    const std::string triple(3, quote);
    at_ += 3;
    while (at_ < text_.size() && text_.substr(at_, 3) != triple) {
      if (!is_ascii(text_[at_])) {
        fail("a letter beyond ASCII in a string of several lines", "write it in one line");
      }
      step(quote);
    }
    while (at_ < text_.size() && text_[at_] == quote) ++at_;  // it may end in up to two quotes more
  }

  /// One character of a string, or two where the first escapes the second.
  void step(char quote) {
    const bool is_escape = quote == '"' && text_[at_] == '\\' && at_ + 1 < text_.size();
    at_ += is_escape && text_[at_ + 1] != '\n' && is_ascii(text_[at_ + 1]) ? 2 : 1;
  }

  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    const auto here = text_.begin() + static_cast<std::ptrdiff_t>(at_);
    throw InputError({file_name_, 1 + std::count(text_.begin(), here, '\n'), 0}, what, remedy);
  }

  std::string_view text_;
  const std::string& file_name_;
  std::size_t at_ = 0;
  int num_dots_ = 0;
};

}  // namespace

void check_text(std::string_view text, const std::string& file_name) {
  TextCheck(text, file_name).run();
}

}  // namespace barchan::deck
