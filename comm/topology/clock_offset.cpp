#include <barchan/comm/topology/clock_offset.hpp>

#include <limits>

#include <barchan/comm/base/call_watch.hpp>
#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/topology/links.hpp>
#include <barchan/core/base/clock.hpp>

namespace barchan {
namespace {

constexpr int kNumTrips = 50;
constexpr int kTripTag = 3;

void send(MPI_Comm comm, int to, std::int64_t value) {
  check_watched("MPI_Send", [&] { return MPI_Send(&value, 1, MPI_INT64_T, to, kTripTag, comm); });
}

std::int64_t receive(MPI_Comm comm, int from) {
  std::int64_t value = 0;
  check_watched("MPI_Recv", [&] {
    return MPI_Recv(&value, 1, MPI_INT64_T, from, kTripTag, comm, MPI_STATUS_IGNORE);
  });
  return value;
}

void answer(MPI_Comm comm, int rank) {
  for (int trip = 0; trip < kNumTrips; ++trip) {
    (void)receive(comm, rank);
    send(comm, rank, now_ns());
  }
}

std::int64_t ask(MPI_Comm comm) {
  std::int64_t shortest = std::numeric_limits<std::int64_t>::max(), offset = 0;
  for (int trip = 0; trip < kNumTrips; ++trip) {
    const std::int64_t begin = now_ns();
    send(comm, 0, trip);
    const std::int64_t theirs = receive(comm, 0);
    const std::int64_t end = now_ns();
    if (end - begin >= shortest) continue;
    shortest = end - begin;
    offset = theirs - (begin + (end - begin) / 2);
  }
  return offset;
}

}  // namespace

std::int64_t clock_offset_ns(const Communicator& communicator) {
  const auto nodes = nodes_of_ranks(communicator);
  std::int64_t offset = 0;
  for (int rank = 1; rank < communicator.size(); ++rank) {
    if (nodes[static_cast<std::size_t>(rank)] == nodes[0]) continue;
    if (communicator.is_root()) answer(communicator.handle(), rank);
    if (communicator.rank() == rank) offset = ask(communicator.handle());
  }
  return offset;
}

}  // namespace barchan
