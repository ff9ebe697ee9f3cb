#pragma once

#include <cstdint>

namespace barchan {

/// Work for measurements: a number of rounds that takes the given time on a quiet machine. Other
/// users of the core (the kernel's TCP, other processes) make it longer, as they do with real work;
/// a loop that watched the clock would hide that.
class SpinWork {
 public:
  SpinWork();  ///< measures this core, about a millisecond
  void run(double seconds);

 private:
  void spin(std::int64_t num_rounds);

  double rounds_per_second_ = 1e9;
  std::uint64_t state_ = 88172645463325252U;
  volatile std::uint64_t sink_ = 0;
};

}  // namespace barchan
