#include <barchan/comm/base/call_watch.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/comm/base/watchdog.hpp>

namespace barchan {
namespace {

/// The limit is over for all ranks at about the same time; each has time for its words.
constexpr std::chrono::seconds kLastWords{5};
constexpr double kLongestNap = 5.0;  // s

/// A wrong BARCHAN_WAIT_LIMIT is told by those who can.
double limit_or_default() {
  try {
    return wait_limit();
  } catch (const InputError&) {
    return kDefaultWaitLimit;
  }
}

/// Between two looks at the clock [s].
double nap() {
  return std::min(0.1 * limit_or_default(), kLongestNap);
}

/// In MPI_COMM_WORLD, which no call of MPI is worth twice; before MPI_Init: -1.
int world_rank() {
  static std::atomic<int> known{-1};
  int rank = known.load(std::memory_order_relaxed);
  if (rank < 0 && is_mpi_initialized()) {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    known.store(rank, std::memory_order_relaxed);
  }
  return rank;
}

}  // namespace

/// The calls that threads of this process are in, and the thread that looks at the clock.
class CallWatcher {
 public:
  static CallWatcher& get() {
    static CallWatcher watcher;
    return watcher;
  }

  void add(CallWatch& watch) {
    const std::scoped_lock lock(mutex_);
    watch.begin_ = now();
    watch.after_ = first_;
    if (first_ != nullptr) first_->before_ = &watch;
    first_ = &watch;
  }

  void remove(CallWatch& watch) {
    const std::scoped_lock lock(mutex_);
    (watch.before_ != nullptr ? watch.before_->after_ : first_) = watch.after_;
    if (watch.after_ != nullptr) watch.after_->before_ = watch.before_;
  }

 private:
  CallWatcher() : thread_([this] { look(); }) {}
  ~CallWatcher() {
    {
      const std::scoped_lock lock(mutex_);
      is_over_ = true;
    }
    over_.notify_all();
    thread_.join();
  }

  /// Seconds, less those in which the process was stopped: after them it is not for this rank to
  /// say who hangs. With the lock held.
  double now() const { return awake_ + std::min(seconds_since(looked_), 2.0 * nap()); }

  void look() {
    std::unique_lock lock(mutex_);
    while (!is_over_) {
      awake_ = now();
      looked_ = now_ns();
      for (const CallWatch* watch = first_; watch != nullptr; watch = watch->after_) {
        const double waited = awake_ - watch->begin_;
        if (waited > watch->patience_ * limit_or_default()) end(*watch, waited);
      }
      over_.wait_until(lock, std::chrono::system_clock::now() +
                                 std::chrono::duration_cast<std::chrono::milliseconds>(
                                     std::chrono::duration<double>(nap())));
    }
  }

  [[noreturn]] static void end(const CallWatch& watch, double seconds) {
    const std::string who = watch.rank_ < 0 ? "a rank" : "rank " + std::to_string(watch.rank_);
    const std::string what = who + ": " + watch.call_ + ", in which other ranks take part";
    std::fprintf(stderr, "barchan: %s\n", words_of_wait(seconds, what).c_str());
    std::fflush(stderr);
    std::this_thread::sleep_for(kLastWords);
    std::_Exit(EXIT_FAILURE);
  }

  std::mutex mutex_;
  std::condition_variable over_;
  bool is_over_ = false;
  std::int64_t looked_ = now_ns();
  double awake_ = 0.0;  ///< when it looked, by now()
  CallWatch* first_ = nullptr;
  std::thread thread_;  ///< last: it looks at all the others
};

CallWatch::CallWatch(const char* call, double patience) noexcept
    : call_(call), patience_(patience), rank_(world_rank()) {
  try {
    CallWatcher::get().add(*this);
  } catch (const std::exception&) {  // no thread to be had: nobody watches
    call_ = nullptr;
  }
}

CallWatch::~CallWatch() {
  if (call_ != nullptr) CallWatcher::get().remove(*this);
}

}  // namespace barchan
