#include <barchan/tasks/progress_thread.hpp>

#include <exception>
#include <utility>

#include <barchan/comm/base/backoff.hpp>

namespace barchan {

ProgressThread::ProgressThread(std::function<void()> drive, std::mutex& guard)
    : drive_(std::move(drive)), guard_(guard), thread_([this] { run(); }) {}

ProgressThread::~ProgressThread() {
  must_end_ = true;
  thread_.join();
}

void ProgressThread::pause() {
  is_working_ = false;
  const std::lock_guard<std::mutex> lock(guard_);  // the last drive is over
}

// Workers that need the guard must get it, so each drive is followed by a yield; and between steps
// the core is given away only after a while, since steps are short.
void ProgressThread::run() {
  Backoff backoff;
  while (!must_end_) {
    if (is_working_) {
      const std::unique_lock<std::mutex> lock(guard_, std::try_to_lock);
      try {
        if (lock.owns_lock() && is_working_) drive_();
      } catch (const std::exception&) {
        is_working_ = false;  // a worker meets the same error, and tells it
      }
      backoff.reset();
    }
    if (is_working_)
      sched_yield();
    else
      backoff.pause();
  }
}

}  // namespace barchan
