#include <barchan/comm/base/first_to_fail.hpp>

#include <thread>

#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/core/base/clock.hpp>

namespace barchan {
namespace {

constexpr int kFailureTag = 4;
constexpr std::chrono::milliseconds kPause{5};

/// What another rank found, if one has said so by now.
bool hear(MPI_Comm comm, StepError::Order& order, int& rank) {
  int is_there = 0;
  MPI_Status status;
  check(MPI_Iprobe(MPI_ANY_SOURCE, kFailureTag, comm, &is_there, &status), "MPI_Iprobe");
  if (is_there == 0) return false;
  rank = status.MPI_SOURCE;
  check(MPI_Recv(order.data(), static_cast<int>(order.size()), MPI_INT64_T, rank, kFailureTag, comm,
                 MPI_STATUS_IGNORE),
        "MPI_Recv");
  return true;
}

}  // namespace

bool is_first_to_fail(const Communicator& communicator, const StepError::Order& order,
                      std::chrono::milliseconds time) {
  const std::int64_t end = now_ns() + std::chrono::nanoseconds(time).count();
  // Some may never take these few bytes; requests and numbers are left to the program's end.
  static StepError::Order told;
  told = order;
  for (int rank = 0; rank < communicator.size(); ++rank) {
    MPI_Request request = MPI_REQUEST_NULL;
    if (rank == communicator.rank()) continue;
    check(MPI_Isend(told.data(), static_cast<int>(told.size()), MPI_INT64_T, rank, kFailureTag,
                    communicator.handle(), &request),
          "MPI_Isend");
  }
  bool is_first = true;
  while (now_ns() < end) {
    StepError::Order other_order{};
    int other = 0;
    while (hear(communicator.handle(), other_order, other)) {
      if (other_order < order || (other_order == order && other < communicator.rank()))
        is_first = false;
    }
    std::this_thread::sleep_for(kPause);
  }
  return is_first;
}

}  // namespace barchan
