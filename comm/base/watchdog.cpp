#include <barchan/comm/base/watchdog.hpp>

#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

double limit_of_environment() {
  const char* text = std::getenv("BARCHAN_WAIT_LIMIT");
  if (text == nullptr || *text == '\0') return kDefaultWaitLimit;
  double seconds = 0.0;
  const char* end = text + std::strlen(text);
  const auto [stop, error] = std::from_chars(text, end, seconds);
  if (error != std::errc{} || stop != end || !(seconds > 0.0) || !std::isfinite(seconds)) {
    throw InputError(std::string("BARCHAN_WAIT_LIMIT is '") + text + "'",
                     "give a positive number of seconds");
  }
  return seconds;
}

std::atomic<double>& limit() {
  static std::atomic<double> seconds{limit_of_environment()};
  return seconds;
}

}  // namespace

double wait_limit() {
  return limit().load(std::memory_order_relaxed);
}

void set_wait_limit(double seconds) {
  if (!(seconds > 0.0) || !std::isfinite(seconds)) {
    throw InputError("wait limit is not a positive number", "give a positive number of seconds");
  }
  limit().store(seconds, std::memory_order_relaxed);
}

std::string words_of_wait(double seconds, const std::string& what) {
  std::ostringstream text;
  text << "gave up after waiting " << seconds << " s for " << what
       << "; another rank may have died or may hang (BARCHAN_WAIT_LIMIT sets the limit [s])";
  return text.str();
}

void Watchdog::expire(const std::string& what) const {
  throw WaitError(words_of_wait(seconds(), what));
}

}  // namespace barchan
