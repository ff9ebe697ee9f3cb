#pragma once

#include <sched.h>

#include <chrono>
#include <thread>

namespace barchan {

/// How a waiting thread spends its empty polls: spin, then give the core away, then sleep briefly.
/// With more ranks than cores a rank that only spins starves the one that it waits for, for a whole
/// time slice.
class Backoff {
 public:
  static constexpr int kNumSpins = 300;
  static constexpr int kNumYields = 3000;
  static constexpr std::chrono::microseconds kNap{50};

  /// Once after each empty poll.
  void pause() {
    if (num_pauses_ < kNumSpins) {
      ++num_pauses_;
    } else if (num_pauses_ < kNumSpins + kNumYields) {
      ++num_pauses_;
      sched_yield();
    } else {
      std::this_thread::sleep_for(kNap);
    }
  }

  /// Once something came in.
  void reset() { num_pauses_ = 0; }

 private:
  int num_pauses_ = 0;
};

}  // namespace barchan
