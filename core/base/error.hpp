#pragma once

#include <array>
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

/// A RunError that one rank finds in a step. Other ranks may find one, too: the one to report is
/// the first, which one rank alone would report.
class StepError : public RunError {
 public:
  /// The lower the earlier: step, kind of error, ids of those that it is about.
  using Order = std::array<std::int64_t, 4>;
  StepError(const Order& order, const std::string& what) : RunError(what), order_(order) {}
  [[nodiscard]] const Order& order() const { return order_; }

 private:
  Order order_;
};

/// A RunError that every rank throws with the same text, so that rank 0 prints it for all.
class CommonError : public RunError {
 public:
  using RunError::RunError;
};

/// A CommonError that every rank throws between the same two steps, so that they can still write
/// results together.
class AgreedError : public CommonError {
 public:
  /// @param can_go_on  the state is sound, so a restart under another rule can continue from here
  explicit AgreedError(const std::string& what, bool can_go_on = false)
      : CommonError(what), can_go_on_(can_go_on) {}
  [[nodiscard]] bool can_go_on() const { return can_go_on_; }

 private:
  bool can_go_on_;
};

}  // namespace barchan
