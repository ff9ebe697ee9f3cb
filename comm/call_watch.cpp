#include <barchan/comm/call_watch.hpp>

#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

#include <barchan/comm/mpi_session.hpp>
#include <barchan/comm/watchdog.hpp>

namespace barchan {
namespace {

/// The limit is over for all ranks at about the same time; each has time for its words.
constexpr std::chrono::seconds last_words{5};
constexpr double usual_limit = 120.0;  // s
constexpr double longest_nap = 5.0;    // s

/// A wrong BARCHAN_WAIT_LIMIT is told by those who can.
double limit_or_usual() {
  try {
    return wait_limit();
  } catch (const InputError&) {
    return usual_limit;
  }
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

  void look() {
    std::unique_lock lock(mutex_);
    while (!is_over_) {
      const double limit = limit_or_usual();
      for (const CallWatch* watch = first_; watch != nullptr; watch = watch->after_) {
        const std::chrono::duration<double> waited =
            std::chrono::steady_clock::now() - watch->begin_;
        if (waited.count() > watch->patience_ * limit) end(*watch, waited.count());
      }
      const auto nap = std::chrono::duration<double>(std::min(0.1 * limit, longest_nap));
      over_.wait_until(lock, std::chrono::system_clock::now() +
                                 std::chrono::duration_cast<std::chrono::milliseconds>(nap));
    }
  }

  static std::string who(const CallWatch& watch) {
    return watch.rank_ < 0 ? "a rank" : "rank " + std::to_string(watch.rank_);
  }

  [[noreturn]] static void end(const CallWatch& watch, double seconds) {
    std::fprintf(
        stderr,
        "barchan: waited %.3g s in vain for %s: %s, in which other ranks take part; another "
        "rank may have died or hang (the limit is BARCHAN_WAIT_LIMIT, in seconds)\n",
        seconds, who(watch).c_str(), watch.call_);
    std::fflush(stderr);
    std::this_thread::sleep_for(last_words);
    std::_Exit(EXIT_FAILURE);
  }

  std::mutex mutex_;
  std::condition_variable over_;
  bool is_over_ = false;
  CallWatch* first_ = nullptr;
  std::thread thread_;  ///< last: it looks at all the others
};

CallWatch::CallWatch(const char* call, double patience) noexcept
    : call_(call), patience_(patience), begin_(std::chrono::steady_clock::now()) {
  if (is_mpi_initialized()) MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
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
