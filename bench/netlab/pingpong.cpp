// Two-sided ping-pong between the first and the last rank: half a round trip and bandwidth for
// message sizes. mpicxx -O2 pingpong.cpp; pingpong [BYTES...]
#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

struct Peers {
  int rank = 0;
  int other = 0;
};

void bounce(std::vector<char>& message, const Peers& peers) {
  const int bytes = static_cast<int>(message.size());
  const auto send = [&] {
    MPI_Send(message.data(), bytes, MPI_CHAR, peers.other, 0, MPI_COMM_WORLD);
  };
  const auto receive = [&] {
    MPI_Recv(message.data(), bytes, MPI_CHAR, peers.other, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  };
  if (peers.rank == 0) send();
  receive();
  if (peers.rank != 0) send();
}

/// Half round trips [µs], sorted; for about half a second after a short warm-up.
std::vector<double> half_round_trips(int bytes, const Peers& peers) {
  std::vector<char> message(bytes);
  for (int n = 0; n < 20; ++n) bounce(message, peers);
  double start = MPI_Wtime();
  for (int n = 0; n < 5; ++n) bounce(message, peers);
  int rounds = std::clamp(static_cast<int>(0.5 / ((MPI_Wtime() - start) / 5 + 1e-9)), 10, 20000);
  if (peers.rank == 0)
    MPI_Send(&rounds, 1, MPI_INT, peers.other, 1, MPI_COMM_WORLD);
  else
    MPI_Recv(&rounds, 1, MPI_INT, peers.other, 1, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  std::vector<double> times;
  for (int n = 0; n < rounds; ++n) {
    start = MPI_Wtime();
    bounce(message, peers);
    times.push_back(0.5e6 * (MPI_Wtime() - start));
  }
  std::sort(times.begin(), times.end());
  return times;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int rank = 0;
  int size = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  if (size < 2) {
    std::fprintf(stderr, "pingpong: needs at least 2 ranks\n");
    MPI_Abort(MPI_COMM_WORLD, 2);
  }
  std::vector<int> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(std::max(0, std::atoi(argv[i])));
  if (sizes.empty()) sizes = {8, 64, 1024, 8192, 65536, 1 << 20};
  if (rank == 0)
    std::printf("%10s %12s %12s %12s %12s\n", "bytes", "median_us", "p10_us", "p99_us", "MB_per_s");
  for (const int bytes : sizes) {
    if (rank == 0 || rank == size - 1) {
      const auto times = half_round_trips(bytes, {rank, rank == 0 ? size - 1 : 0});
      const auto at = [&](double share) {
        return times[static_cast<std::size_t>(share * double(times.size() - 1))];
      };
      if (rank == 0)
        std::printf("%10d %12.1f %12.1f %12.1f %12.1f\n", bytes, at(0.5), at(0.1), at(0.99),
                    bytes / at(0.5));
      std::fflush(stdout);
    }
  }
  MPI_Finalize();
}
