#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/comm/base/watchdog.hpp>

namespace barchan {

/// Non-blocking all-reduce of a fixed small set: maxima of doubles and sums of integers, both
/// exact, so that the order of the ranks is nowhere in the result. NaN wins over any number; -0
/// becomes +0.
///
///     begin → test … test → maxima(), sums()    and again
///
/// On up to `num_direct_ranks` ranks everybody sends to everybody (persistent requests: one message
/// deep, which hides best and costs least on a node); on more one MPI_Iallreduce with an operation
/// of our own. A lone rank only copies. Every instance has its own communicator, so several may be
/// in flight, in any order on any rank. Construction is collective; begin is, too, but waits for
/// nobody. One thread at a time.
class Reduction {
 public:
  static constexpr int kDefaultDirectRanks = 8;

  Reduction(const Communicator& communicator, std::size_t num_maxima, std::size_t num_sums,
            int num_direct_ranks = kDefaultDirectRanks);
  ~Reduction();
  Reduction(const Reduction&) = delete;
  Reduction& operator=(const Reduction&) = delete;

  /// Errors: std::logic_error for other numbers of values than constructed, or while one is in
  /// flight.
  void begin(std::span<const double> maxima, std::span<const std::int64_t> sums);
  /// True once the result is there, and until the next begin. Never blocks; lets the library make
  /// progress.
  [[nodiscard]] bool test();
  /// Errors: WaitError.
  void wait(double limit_seconds = wait_limit());

  [[nodiscard]] std::span<const double> maxima() const;      ///< @pre test()
  [[nodiscard]] std::span<const std::int64_t> sums() const;  ///< @pre test()
  [[nodiscard]] bool is_in_flight() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace barchan
