#pragma once

#include <chrono>
#include <cstdint>

namespace barchan {

/// Steady clock [ns]; the same clock for every process of a node.
[[nodiscard]] inline std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

[[nodiscard]] constexpr double to_seconds(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}
[[nodiscard]] inline double seconds_since(std::int64_t begin_ns) {
  return to_seconds(now_ns() - begin_ns);
}

/// Adds the seconds of its own life to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(&sum) {}
  ~Stopwatch() { *sum_ += seconds_since(begin_); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double* sum_;
  std::int64_t begin_ = now_ns();
};

}  // namespace barchan
