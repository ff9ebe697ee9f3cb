/* barchan from C: spheres sink in oil until drag and weight balance (fluid.toml).
 *
 *     cc sink.c -o sink $(pkg-config --cflags --libs barchan) -lmpi -lm
 *     mpirun -n 2 ./sink fluid.toml
 *
 * Loads are written in place. The first window is done twice, as an implicit coupling would do.
 */
#include <barchan.h>
#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

static const double kPi = 3.14159265358979323846;
static const double kViscosity = 0.05, kDensity = 2500.0, kFluid = 970.0, kGravity = 9.81;

/* Ends all ranks: this one may be the only one that knows. */
static void check(int code) {
  if (code == BARCHAN_OK) return;
  fprintf(stderr, "sink: %s\n", barchan_error());
  MPI_Abort(MPI_COMM_WORLD, 1);
}

/* Drag and buoyancy on every sphere of this rank. */
static void couple(barchan_sim* sim) {
  barchan_info info;
  check(barchan_get_info(sim, &info));
  for (int b = 0; b < info.num_bricks; ++b) {
    barchan_view v, r;
    barchan_loads f;
    check(barchan_get_view(sim, b, BARCHAN_VELOCITY, &v));
    check(barchan_get_view(sim, b, BARCHAN_RADIUS, &r));
    check(barchan_get_loads(sim, b, &f));
    for (int64_t i = 0; i < v.size; ++i) {
      const double radius = r.data[i * r.stride];
      const double drag = 6.0 * kPi * kViscosity * radius;
      const double displaced = 4.0 / 3.0 * kPi * radius * radius * radius * kFluid;
      for (int c = 0; c < 3; ++c)
        f.forces[i * f.stride + c] = -drag * v.data[i * v.stride + c];
      f.forces[i * f.stride + 2] += displaced * kGravity;
    }
  }
}

static double sinking(barchan_sim* sim, int64_t* count) {
  double sum = 0.0;
  barchan_info info;
  check(barchan_get_info(sim, &info));
  for (int b = 0; b < info.num_bricks; ++b) {
    barchan_view v;
    check(barchan_get_view(sim, b, BARCHAN_VELOCITY, &v));
    for (int64_t i = 0; i < v.size; ++i) sum += v.data[i * v.stride + 2];
  }
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  *count = info.num_particles;
  return sum / (double)info.num_particles;
}

int main(int argc, char** argv) {
  int level = 0, rank = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const int comm = (int)MPI_Comm_c2f(MPI_COMM_WORLD);

  barchan_sim* sim = NULL;
  check(barchan_open(argc > 1 ? argv[1] : "fluid.toml", "--threads=1", comm, &sim));
  barchan_state* before = NULL;
  check(barchan_save(sim, &before));
  for (int turn = 0; turn < 2; ++turn) {
    check(barchan_load(sim, before));
    couple(sim);
    check(barchan_run(sim, 10, NULL));
  }
  check(barchan_free_state(before));

  const double r = 0.5e-3, mass = kDensity * 4.0 / 3.0 * kPi * r * r * r;
  const double relaxation = mass / (6.0 * kPi * kViscosity * r);
  barchan_info info;
  do {
    couple(sim);
    check(barchan_run(sim, 10, NULL));
    check(barchan_get_info(sim, &info));
  } while (info.time < 20.0 * relaxation);

  int64_t count = 0;
  uint64_t digest = 0;
  const double speed = -sinking(sim, &count);
  const double expected = 2.0 / 9.0 * (kDensity - kFluid) * kGravity * r * r / kViscosity;
  check(barchan_digest(sim, &digest));
  check(barchan_close(sim));
  if (rank == 0)
    printf("%lld spheres sink at %.6g mm/s, theory says %.6g mm/s; digest %016llx\n",
           (long long)count, 1e3 * speed, 1e3 * expected, (unsigned long long)digest);
  MPI_Finalize();
  return fabs(speed / expected - 1.0) < 1e-3 ? 0 : 1;
}
