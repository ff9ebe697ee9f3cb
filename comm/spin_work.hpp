#pragma once

#include <cstdint>

namespace barchan {

/// Work for measurements: keeps the core busy for a number of rounds that takes so many seconds on
/// a quiet machine. What steals the core (the kernel's TCP, somebody else) makes it longer, as it
/// does with real work; a loop that watched the clock would hide that.
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
