#include <barchan/comm/base/first_to_fail.hpp>

#include <thread>

#include <barchan/comm/base/mpi_error.hpp>

namespace barchan {
namespace {

constexpr int failure_tag = 4;
constexpr std::chrono::milliseconds pause{5};

/// What another rank found, if one has said so by now.
bool hear(MPI_Comm comm, StepError::Order& order, int& rank) {
  int is_there = 0;
  MPI_Status status;
  check(MPI_Iprobe(MPI_ANY_SOURCE, failure_tag, comm, &is_there, &status), "MPI_Iprobe");
  if (is_there == 0) return false;
  rank = status.MPI_SOURCE;
  check(MPI_Recv(order.data(), static_cast<int>(order.size()), MPI_INT64_T, rank, failure_tag, comm,
                 MPI_STATUS_IGNORE),
        "MPI_Recv");
  return true;
}

}  // namespace

bool is_first_to_fail(const Communicator& communicator, const StepError::Order& order,
                      std::chrono::milliseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  // Some may never take these few bytes; requests and numbers are left to the program's end.
  static StepError::Order told;
  told = order;
  for (int rank = 0; rank < communicator.size(); ++rank) {
    MPI_Request request = MPI_REQUEST_NULL;
    if (rank == communicator.rank()) continue;
    check(MPI_Isend(told.data(), static_cast<int>(told.size()), MPI_INT64_T, rank, failure_tag,
                    communicator.handle(), &request),
          "MPI_Isend");
  }
  bool is_first = true;
  while (std::chrono::steady_clock::now() < end) {
    StepError::Order other_order{};
    int other = 0;
    while (hear(communicator.handle(), other_order, other)) {
      if (other_order < order || (other_order == order && other < communicator.rank()))
        is_first = false;
    }
    std::this_thread::sleep_for(pause);
  }
  return is_first;
}

}  // namespace barchan
