#pragma once

#include <cstdint>
#include <string>

#include <barchan/comm/base/backoff.hpp>
#include <barchan/core/base/clock.hpp>
#include <barchan/core/base/error.hpp>

namespace barchan {

inline constexpr double kDefaultWaitLimit = 120.0;  ///< [s]

/// The longest that a rank waits for one message [s]. The default, or the environment's
/// BARCHAN_WAIT_LIMIT. Process-wide; set it before the run. Errors: InputError when the variable or
/// `seconds` is not a positive number.
double wait_limit();
void set_wait_limit(double seconds);

/// The same where others read or write files meanwhile: ten times as long.
inline double file_wait_limit() {
  return 10.0 * wait_limit();
}

/// The message about a wait that was given up: "gave up after waiting 120 s for <what>; …".
std::string words_of_wait(double seconds, const std::string& what);

/// A message that never came. Other ranks may wait as well, each for something else.
class WaitError : public RunError {
 public:
  using RunError::RunError;
};

/// A wait has a beginning and a limit; when that is over it is reported, never a silent hang.
class Watchdog {
 public:
  Watchdog() : Watchdog(wait_limit()) {}
  explicit Watchdog(double limit_seconds) : limit_(limit_seconds) {}

  /// Cheap: looks at the clock at every 256th call.
  [[nodiscard]] bool has_expired() { return (++num_calls_ & 255U) == 0 && seconds() > limit_; }
  [[nodiscard]] double seconds() const { return seconds_since(begin_); }

  /// Throws WaitError with words_of_wait().
  [[noreturn]] void expire(const std::string& what) const;

 private:
  double limit_;
  std::int64_t begin_ = now_ns();
  unsigned num_calls_ = 0;
};

/// Polls until `poll()` is true.
/// @param describe  gives the text for a wait that takes too long: which rank waits for which
///                  message of which step from whom, as in
///                  "rank 2: halo message of step 17 from rank 1 (left)"
/// Errors: WaitError after wait_limit() seconds; the caller then ends all ranks
/// (Communicator::abort), since the others may wait for this one.
template <class Poll, class Describe>
void wait_until(Poll&& poll, Describe&& describe, double limit_seconds = wait_limit()) {
  if (poll()) return;
  Backoff backoff;
  Watchdog watchdog(limit_seconds);
  while (!poll()) {
    if (watchdog.has_expired()) watchdog.expire(describe());
    backoff.pause();
  }
}

}  // namespace barchan
