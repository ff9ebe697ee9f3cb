/* Two-way coupling: air flows up through a bed of beads, faster and faster, until it carries them.
 *
 *     cc fluidised_bed.c -o fluidised_bed $(pkg-config --cflags --libs barchan) -lmpi -lm
 *     mpirun -n 2 ./fluidised_bed bed.toml              each window with the porosity at its beginning
 *     mpirun -n 2 ./fluidised_bed bed.toml implicit     with that at its end, by going back
 *
 * The flow is incompressible, in cells along the height. In each, with the porosity e and the flow
 * U' relative to the beads, through unit area, the pressure falls by (Ergun 1952)
 *
 *     G = 150 mu (1-e)^2 / (e^3 d^2) U'  +  1.75 rho (1-e) / (e^3 d) |U'| U'      [Pa/m]
 *
 * and the beads take it up, each by its share of the solid volume. The beads give the flow e and
 * their mean velocity. Where G = (1-e) (rho_s - rho) g, at U = U_mf, air carries the bed. Here that
 * shows at the floor, which barchan knows of and the flow does not: 5 % of the load is left. The sums
 * over beads are in whole numbers, so every bit is the same on any number of ranks.
 */
#include <barchan.h>
#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kCells = 20, kStepsPerWindow = 20, kMostTurns = 20 };
static const double kPi = 3.14159265358979323846;
static const double kHeight = 0.04, kArea = 0.006 * 0.006, kDiameter = 1e-3, kGravity = 9.81;
static const double kViscosity = 1.8e-5, kAir = 1.2, kGlass = 2500.0;
static const double kUnit = 1152921504606846976.0; /* 2^60: of a cell's volume */

/* What the flow knows of the beads, cell by cell. */
typedef struct {
  double porosity[kCells], velocity[kCells]; /* mean of the beads [m/s] */
} Bed;

static void check(int code) {
  if (code == BARCHAN_OK) return;
  fprintf(stderr, "fluidised_bed: %s\n", barchan_error());
  MPI_Abort(MPI_COMM_WORLD, 1);
}

/* Of a sphere around z, the volume below a height. */
static double volume_below(double height, double z, double r) {
  const double h = fmin(fmax(height - (z - r), 0.0), 2.0 * r);
  return kPi * h * h * (3.0 * r - h) / 3.0;
}

/* The cells that a sphere reaches, and its volume in the n-th of them. */
static int first_cell(double z, double r) {
  return (int)fmax(0.0, (z - r) * kCells / kHeight);
}
static double volume_in(int cell, double z, double r) {
  const double dz = kHeight / kCells;
  return volume_below((cell + 1) * dz, z, r) - volume_below(cell * dz, z, r);
}

static Bed look(barchan_sim* sim, int num_bricks) {
  const double cell = kArea * kHeight / kCells;
  int64_t sums[2 * kCells] = {0};
  for (int b = 0; b < num_bricks; ++b) {
    barchan_view x, v, radii;
    check(barchan_get_view(sim, b, BARCHAN_POSITION, &x));
    check(barchan_get_view(sim, b, BARCHAN_VELOCITY, &v));
    check(barchan_get_view(sim, b, BARCHAN_RADIUS, &radii));
    for (int64_t i = 0; i < x.size; ++i) {
      const double z = x.data[i * x.stride + 2], r = radii.data[i * radii.stride];
      for (int c = first_cell(z, r); c < kCells && c * kHeight / kCells < z + r; ++c) {
        const double share = volume_in(c, z, r) / cell;
        sums[c] += llrint(share * kUnit);
        sums[kCells + c] += llrint(share * v.data[i * v.stride + 2] * kUnit / 16.0);
      }
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums, 2 * kCells, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  Bed bed;
  for (int c = 0; c < kCells; ++c) {
    const double solid = (double)sums[c] / kUnit;
    bed.porosity[c] = fmax(0.2, 1.0 - solid);
    bed.velocity[c] = solid > 0.0 ? 16.0 * (double)sums[kCells + c] / kUnit / solid : 0.0;
  }
  return bed;
}

/* Ergun's pressure gradient [Pa/m]. @param flow  relative to the beads [m/s] */
static double gradient(double e, double flow) {
  const double s = 1.0 - e;
  return (150.0 * kViscosity * s * s / (kDiameter * kDiameter) +
          1.75 * kAir * s / kDiameter * fabs(flow)) * flow / (e * e * e);
}

/* Loads of the flow on all beads of this rank. */
static void push(barchan_sim* sim, int num_bricks, const Bed* bed, double flow) {
  for (int b = 0; b < num_bricks; ++b) {
    barchan_view x, v, radii;
    barchan_loads loads;
    check(barchan_get_view(sim, b, BARCHAN_POSITION, &x));
    check(barchan_get_view(sim, b, BARCHAN_VELOCITY, &v));
    check(barchan_get_view(sim, b, BARCHAN_RADIUS, &radii));
    check(barchan_get_loads(sim, b, &loads));
    for (int64_t i = 0; i < x.size; ++i) {
      const double z = x.data[i * x.stride + 2], r = radii.data[i * radii.stride];
      double force = 0.0;
      for (int c = first_cell(z, r); c < kCells && c * kHeight / kCells < z + r; ++c) {
        const double e = bed->porosity[c];
        const double air = (flow - (1.0 - e) * bed->velocity[c]) / e; /* as much passes each height */
        const double relative = e * (air - v.data[i * v.stride + 2]);
        force += volume_in(c, z, r) * (gradient(e, relative) / (1.0 - e) + kAir * kGravity);
      }
      loads.forces[i * loads.stride + 2] = force;
    }
  }
}

/* One window. Implicit: until the porosity that pushes is the mean of those at both ends. */
static int advance(barchan_sim* sim, int num_bricks, double flow, int is_implicit,
                   barchan_state** before) {
  const Bed begin = look(sim, num_bricks);
  Bed bed = begin;
  if (is_implicit) check(barchan_save(sim, before));
  for (int turn = 1;; ++turn) {
    push(sim, num_bricks, &bed, flow);
    check(barchan_run(sim, kStepsPerWindow, NULL));
    if (!is_implicit) return turn;
    const Bed end = look(sim, num_bricks);
    double change = 0.0;
    for (int c = 0; c < kCells; ++c) {
      const double e = 0.5 * (begin.porosity[c] + end.porosity[c]);
      change = fmax(change, fabs(e - bed.porosity[c]));
      bed.porosity[c] = e;
      bed.velocity[c] = 0.5 * (begin.velocity[c] + end.velocity[c]);
    }
    if (change < 1e-9 || turn == kMostTurns) return turn;
    check(barchan_load(sim, *before));
  }
}

/* The load on the floor [N], a mean over some windows. */
static double floor_load(barchan_sim* sim, int num_bricks, double flow, int is_implicit,
                         int64_t* turns, barchan_state** before) {
  enum { kSettle = 60, kMeasure = 40 };
  double load = 0.0;
  for (int w = 0; w < kSettle + kMeasure; ++w) {
    *turns += advance(sim, num_bricks, flow, is_implicit, before);
    if (w < kSettle) continue;
    barchan_wall floor;
    check(barchan_measure(sim, NULL));
    check(barchan_get_wall(sim, "floor", &floor));
    load -= floor.force[2] / kMeasure;
  }
  return load;
}

/* The flow that carries a bed of this porosity, from G(U) = (1-e)(rho_s - rho) g. */
static double ergun_velocity(double e) {
  double low = 0.0, high = 10.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    *(gradient(e, middle) < (1.0 - e) * (kGlass - kAir) * kGravity ? &low : &high) = middle;
  }
  return low;
}

int main(int argc, char** argv) {
  int level = 0, rank = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const int is_implicit = argc > 2 && strcmp(argv[2], "implicit") == 0;
  barchan_sim* sim = NULL;
  barchan_state* before = NULL;
  barchan_info info;
  check(barchan_open(argc > 1 ? argv[1] : "bed.toml", "--threads=1",
                     (int)MPI_Comm_c2f(MPI_COMM_WORLD), &sim));
  check(barchan_run(sim, 8000, NULL)); /* the bed settles */
  check(barchan_get_info(sim, &info));

  const Bed bed = look(sim, info.num_bricks);
  double solid = 0.0;
  for (int c = 0; c < kCells; ++c) solid += (1.0 - bed.porosity[c]) * kArea * kHeight / kCells;
  const double weight = solid * (kGlass - kAir) * kGravity;
  double porosity = 0.0;
  int cells = 0;
  for (int c = 1; c + 1 < kCells && bed.porosity[c + 1] < 0.6; ++c) { /* without floor and surface */
    porosity += bed.porosity[c];
    ++cells;
  }
  porosity /= cells;
  const double expected = ergun_velocity(porosity);

  int64_t turns = 0;
  double found = 0.0, flow = 0.0, load_before = weight;
  for (double share = 0.8; found == 0.0 && share < 1.5; share += 0.05) {
    const double last = flow;
    flow = share * expected;
    const double load = floor_load(sim, info.num_bricks, flow, is_implicit, &turns, &before);
    if (rank == 0) printf("flow %.4f m/s: the floor carries %5.1f %% of the bed\n", flow, 100.0 * load / weight);
    if (load < 0.05 * weight)
      found = last + (flow - last) * (load_before - 0.05 * weight) / fmax(load_before - load, 1e-30);
    load_before = load;
  }
  uint64_t digest = 0;
  check(barchan_digest(sim, &digest));
  check(barchan_free_state(before));
  check(barchan_close(sim));
  if (rank == 0)
    printf("%lld beads of porosity %.3f: carried at %.4f m/s, Ergun says %.4f m/s (%+.1f %%); "
           "%lld solutions; digest %016llx\n",
           (long long)info.num_particles, porosity, found, expected,
           100.0 * (found / expected - 1.0), (long long)turns, (unsigned long long)digest);
  MPI_Finalize();
  return fabs(found / expected - 1.0) < 0.1 ? 0 : 1;
}
