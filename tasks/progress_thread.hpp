#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>

namespace barchan {

/// A thread that lets messages advance and does nothing else. It calls `drive` again and again
/// under `guard`, which all other threads hold while in the exchange: one thread at a time.
///
///     resume() → drive, drive, …, → pause() returns: it is out of the exchange, and stays out
class ProgressThread {
 public:
  /// @param drive  must not throw what the run should hear of: workers meet the same error
  /// @param guard  lives longer
  ProgressThread(std::function<void()> drive, std::mutex& guard);
  ~ProgressThread();
  ProgressThread(const ProgressThread&) = delete;
  ProgressThread& operator=(const ProgressThread&) = delete;

  void resume() { is_working_ = true; }
  void pause();

  /// Works as long as this lives. @param thread  null: nothing
  class Shift {
   public:
    explicit Shift(ProgressThread* thread) : thread_(thread) {
      if (thread_ != nullptr) thread_->resume();
    }
    ~Shift() {
      if (thread_ != nullptr) thread_->pause();
    }
    Shift(const Shift&) = delete;
    Shift& operator=(const Shift&) = delete;

   private:
    ProgressThread* thread_;
  };

 private:
  void run();

  std::function<void()> drive_;
  std::mutex& guard_;
  std::atomic<bool> is_working_{false}, must_end_{false};
  std::thread thread_;
};

}  // namespace barchan
