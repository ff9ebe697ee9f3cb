// A ping-pong of puts and nothing else: what `barchan probe` is held against. Knows no line of
// barchan.
//
//   mpirun -n 2 plain_put BYTES...     prints a line for each size: bytes, half a round trip [µs]
//
// A message is MPI_Put of the data, MPI_Win_flush, MPI_Put of its number, MPI_Win_flush; the other
// rank watches for the number. Round trips are timed one by one, by rank 0; the median counts.
#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

constexpr int kWordBytes = 64;  // a cache line before the data
constexpr int num_first = 20;   // round trips that do not count

struct PingPong {
  MPI_Win window;
  std::byte* mine;
  int other;
  std::vector<std::byte> data;
  std::uint64_t number = 0;

  void put() {
    ++number;
    const int bytes = static_cast<int>(data.size());
    MPI_Put(data.data(), bytes, MPI_BYTE, other, kWordBytes, bytes, MPI_BYTE, window);
    MPI_Win_flush(other, window);
    MPI_Put(&number, 8, MPI_BYTE, other, 0, 8, MPI_BYTE, window);
    MPI_Win_flush(other, window);
  }

  void watch(std::uint64_t wanted) const {
    const std::atomic_ref word(*reinterpret_cast<std::uint64_t*>(mine));
    while (word.load(std::memory_order_acquire) < wanted) {
      int is_there = 0;  // lets the library move what is under way
      MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &is_there, MPI_STATUS_IGNORE);
      MPI_Win_sync(window);
    }
  }
};

double half_round_trip(int bytes, int num_trips) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  PingPong game{};
  game.other = 1 - rank;
  game.data.resize(static_cast<std::size_t>(bytes));
  MPI_Win_allocate(kWordBytes + bytes, 1, MPI_INFO_NULL, MPI_COMM_WORLD, &game.mine, &game.window);
  MPI_Win_lock_all(MPI_MODE_NOCHECK, game.window);
  std::fill_n(game.mine, kWordBytes + bytes, std::byte{});
  MPI_Win_sync(game.window);
  MPI_Barrier(MPI_COMM_WORLD);
  std::vector<double> times;
  for (int n = 0; n < num_first + num_trips; ++n) {
    const double begin = MPI_Wtime();
    const std::uint64_t next = game.number + 1;
    if (rank == 0) game.put();
    game.watch(next);
    if (rank == 1) game.put();
    if (n >= num_first) times.push_back(0.5 * (MPI_Wtime() - begin));
  }
  MPI_Win_unlock_all(game.window);
  MPI_Win_free(&game.window);
  std::nth_element(times.begin(), times.begin() + num_trips / 2, times.end());
  return times[static_cast<std::size_t>(num_trips / 2)];
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int rank = 0, size = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  if (size != 2) {
    if (rank == 0)
      std::fprintf(stderr, "plain_put: wants two ranks: mpirun -n 2 plain_put BYTES...\n");
    MPI_Finalize();
    return 2;
  }
  for (int i = 1; i < argc; ++i) {
    const int bytes = std::max(1, std::atoi(argv[i]));
    const double half = half_round_trip(bytes, bytes < 100000 ? 1000 : 100);
    if (rank == 0) std::printf("%d %.4f\n", bytes, 1e6 * half);
  }
  MPI_Finalize();
  return 0;
}
