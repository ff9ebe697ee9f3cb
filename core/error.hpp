#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace barchan {

/// Where in an input an error lies; zero means "does not apply".
struct SourcePlace {
  std::string file;
  std::int64_t line = 0;
  std::int64_t column = 0;
};

/// The user's input is wrong: what is wrong, where, and what would be right. The command exits
/// with 2.
class InputError : public std::runtime_error {
 public:
  /// what() reads `file:line:column: what (remedy)`.
  InputError(SourcePlace place, const std::string& what, const std::string& remedy);
  InputError(const std::string& what, const std::string& remedy);

  [[nodiscard]] const SourcePlace& place() const { return place_; }

 private:
  SourcePlace place_;
};

/// The run went wrong: a non-finite state, a full disk, a lost message. The command saves what it
/// can and exits with 1.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace barchan
