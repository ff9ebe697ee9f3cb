// Prints the digest of a run, which no flag of this program's own compiler may change: inline
// functions of barchan's headers that it compiles, too, are not those that barchan calls.
#include <mpi.h>

#include <cstdint>
#include <cstdio>
#include <exception>

#include <barchan/core/base/exact_sum.hpp>
#include <barchan/core/links/walls.hpp>
#include <barchan/core/search/grid.hpp>
#include <barchan/tasks/open_deck.hpp>

namespace {

/// Functions that barchan uses, too, as this program compiles them. @return some number
double use_inline_functions(double x) {
  barchan::ExactSum sum;
  sum.add(x);
  sum.carry();
  const barchan::Vec3 v(x, 2.0 * x, 3.0 * x);
  const barchan::PeriodicBox box{};
  const double a[3] = {x, x, x}, b[3] = {2.0 * x, x, x};
  barchan::WallState wall;
  wall.point += 0.5 * v;
  return sum.value() + v.norm() + box.nearest(x, 0) + barchan::distance2<3>(box, a, b) +
         wall.point.squaredNorm();
}

std::uint64_t digest_of(const char* deck) {
  barchan::Simulation sim = barchan::open_deck({deck, "", {}}, MPI_COMM_WORLD);
  sim.run(300);
  return sim.digest();
}

}  // namespace

int main(int argc, char** argv) {
  int level = 0, rank = 0, status = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  try {
    const std::uint64_t digest = digest_of(argv[1]);
    if (rank == 0)
      std::printf("%016llx%s\n", static_cast<unsigned long long>(digest),
                  use_inline_functions(argc) > 0.0 ? "" : " ");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    status = 1;
  }
  MPI_Finalize();
  return status;
}
