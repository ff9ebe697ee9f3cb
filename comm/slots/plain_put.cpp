#include <barchan/comm/slots/plain_put.hpp>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include <barchan/comm/base/call_watch.hpp>
#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/watchdog.hpp>
#include <barchan/comm/base/window.hpp>
#include <barchan/core/base/clock.hpp>

namespace barchan {
namespace {

// | word, on a cache line of its own | data ... |
constexpr std::size_t kDataOffset = 64;

struct Put {
  const Window& window;
  std::vector<std::byte> data;
  int other;
  MPI_Comm comm;
  std::uint64_t number = 0;

  void send() {
    ++number;
    const int count = mpi_count(data.size());
    check(
        MPI_Put(data.data(), count, MPI_BYTE, other, kDataOffset, count, MPI_BYTE, window.handle()),
        "MPI_Put");
    check(MPI_Win_flush(other, window.handle()), "MPI_Win_flush");
    check(MPI_Put(&number, 8, MPI_BYTE, other, 0, 8, MPI_BYTE, window.handle()), "MPI_Put");
    check(MPI_Win_flush(other, window.handle()), "MPI_Win_flush");
  }

  bool is_in(std::uint64_t wanted) const {
    const auto word = [this] {
      return std::atomic_ref(*reinterpret_cast<std::uint64_t*>(window.base()))
          .load(std::memory_order_acquire);
    };
    if (word() >= wanted) return true;
    int is_there = 0;
    check(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm, &is_there, MPI_STATUS_IGNORE),
          "MPI_Iprobe");
    check(MPI_Win_sync(window.handle()), "MPI_Win_sync");
    return word() >= wanted;
  }

  void wait(std::uint64_t wanted) const {
    wait_until([&] { return is_in(wanted); },
               [&] { return "plain put " + std::to_string(wanted); });
  }
};

double bounce(Put& put, bool begins) {
  const std::int64_t begin = now_ns();
  const std::uint64_t next = put.number + 1;
  if (begins) put.send();
  put.wait(next);
  if (!begins) put.send();
  return 0.5e-9 * static_cast<double>(now_ns() - begin);
}

double median_bounce(Put& put, bool begins, int count) {
  const CallWatch watch("MPI_Win_flush");  // one for all of them, which would cost as much as they
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(count));
  for (int n = 0; n < count; ++n) times.push_back(bounce(put, begins));
  std::ranges::nth_element(times, times.begin() + count / 2);
  return times[static_cast<std::size_t>(count / 2)];
}

}  // namespace

double plain_put_half_round_trip(const Communicator& caller, std::size_t bytes,
                                 double budget_seconds) {
  const Communicator communicator = caller.duplicate();
  Window window(communicator, kDataOffset + bytes);
  window.lock_all();
  communicator.barrier();
  const bool begins = communicator.rank() % 2 == 0;
  const int other = communicator.rank() + (begins ? 1 : -1);
  const bool is_in_pair = other < communicator.size();
  Put put{window, std::vector<std::byte>(bytes), other, communicator.handle()};
  double longest = is_in_pair ? median_bounce(put, begins, 5) : 0.0;
  communicator.allreduce_max(std::span(&longest, 1));
  const auto count =
      static_cast<int>(std::clamp(0.5 * budget_seconds / std::max(longest, 1e-7), 7.0, 1000.0));
  longest = is_in_pair ? median_bounce(put, begins, count) : 0.0;
  communicator.allreduce_max(std::span(&longest, 1));
  return longest;
}

}  // namespace barchan
