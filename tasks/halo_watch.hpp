#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <barchan/tasks/progress_thread.hpp>
#include <barchan/tasks/run_options.hpp>
#include <barchan/tasks/step_clock.hpp>
#include <barchan/tasks/strip.hpp>

namespace barchan {

/// Looks for the halos of a step, and tells the graph when one is in: what MPI has done is known by
/// asking only.
///
/// A chunk that ends polls the exchange under a try-lock. When all halos are in, it still lets the
/// exchange advance, since neighbours may wait for the rest of what this rank sent. Where messages
/// arrive without polls, workers do not poll while every lane has chunks left. When no chunk is
/// left, a task awaits what is missing. With Progress::Thread a thread polls all the time, and
/// chunks only read what it found.
template <int Dim>
class HaloWatch {
 public:
  /// @param tell_arrival  called under the guard, once a step and link that is awaited
  HaloWatch(Strip<Dim>& strip, StepClock& clock, Progress progress,
            std::function<void(int)> tell_arrival);

  /// Of a run of steps. @pre no task runs
  void begin_run();
  /// The progress thread works as long as this lives.
  [[nodiscard]] ProgressThread::Shift shift() { return ProgressThread::Shift(driver_.get()); }
  [[nodiscard]] bool is_in(int link) const { return is_in_[static_cast<std::size_t>(link)]; }

  /// @param now  when the chunk ended
  void after_chunk(int lane, bool is_last_of_lane, std::int64_t now);
  /// Returns when the left bands' halos are in, or all are. Errors: WaitError
  void await(bool left_only);

  /// One thread at a time in the exchange.
  [[nodiscard]] std::mutex& guard() { return guard_; }
  /// The right neighbour has all that it needs for its answer. @pre guard is held
  void left_band_is_done() { left_is_done_ = true; }

 private:
  [[nodiscard]] bool all_are_in() const { return num_missing_ == 0; }
  [[nodiscard]] bool left_are_in() const;
  [[nodiscard]] bool is_poll_of_use() const;
  void try_poll(std::int64_t begin);
  void poll_links();
  void drive();
  [[nodiscard]] bool may_poll(int link) const;
  void notice(int link);
  [[nodiscard]] std::string name_of_missing() const;

  Strip<Dim>& strip_;
  StepClock& clock_;
  std::function<void(int)> tell_arrival_;
  std::mutex guard_;
  std::deque<std::atomic<bool>> is_in_;  ///< by link
  std::atomic<int> num_missing_{0};
  std::vector<int> found_;  ///< by the poll at hand
  std::atomic<int> lanes_in_chunks_{0};
  std::atomic<bool> left_is_done_{false};
  std::unique_ptr<ProgressThread> driver_;  ///< last: it ends first; null: workers poll
};

extern template class HaloWatch<2>;
extern template class HaloWatch<3>;

}  // namespace barchan
