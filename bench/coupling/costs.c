/* The shortest times of calls of barchan.h, in turns: prints {"name": seconds} as JSON. Compiled and run by `coupling` beside it.
 *
 *     costs DECK SETTINGS REPETITIONS
 */
#include <barchan.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const int kStepsAtATime = 10;
static barchan_sim* sim = NULL;
static barchan_state* state = NULL;
static int64_t count = 0, *ids = NULL, *ids_gathered = NULL;
static double *forces = NULL, *gathered = NULL, sums[3];

static void check(int code) {
  if (code == BARCHAN_OK) return;
  fprintf(stderr, "costs: %s\n", barchan_error());
  exit(1);
}

static void step(void) { check(barchan_run(sim, kStepsAtATime, NULL)); }
static void read_positions(void) {
  barchan_view x;
  check(barchan_get_view(sim, 0, BARCHAN_POSITION, &x));
  double a = 0.0, b = 0.0;
  for (int64_t i = 0; i < x.size; ++i) {
    a += x.data[i * x.stride];
    b += x.data[i * x.stride + 1];
  }
  sums[0] += a;
  sums[1] += b;
}
static void in_place(void) {
  barchan_loads loads;
  check(barchan_get_loads(sim, 0, &loads));
  for (int64_t i = 0; i < loads.size; ++i)
    for (int c = 0; c < 2; ++c) loads.forces[i * loads.stride + c] = 1e-9;
}
static void by_id(void) { check(barchan_set_loads(sim, count, ids, forces, NULL)); }
static void gather(void) {
  check(barchan_gather(sim, BARCHAN_POSITION, count, ids_gathered, gathered, NULL));
}
static void save(void) { check(barchan_save(sim, &state)); }
static void load(void) { check(barchan_load(sim, state)); }

static const struct {
  const char* name;
  void (*work)(void);
} kCalls[] = {{"a step", step},
              {"read all positions", read_positions},
              {"set all loads in place", in_place},
              {"set all loads by id", by_id},
              {"gather all positions", gather},
              {"keep a state", save},
              {"go back to it", load}};
enum { kNumCalls = sizeof(kCalls) / sizeof(kCalls[0]) };

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The order of rows that set_loads gets, as a partner has it that asks after every rebuild. */
static void take_ids(void) {
  const int64_t* now_ids = NULL;
  check(barchan_get_ids(sim, 0, &now_ids, &count));
  memcpy(ids, now_ids, (size_t)count * sizeof(int64_t));
}

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const int repetitions = atoi(argv[3]);
  check(barchan_start_mpi());
  check(barchan_open(argv[1], argv[2], barchan_world(), &sim));
  barchan_info info;
  check(barchan_get_info(sim, &info));
  const size_t n = (size_t)info.num_particles;
  ids = malloc(n * sizeof(int64_t));
  ids_gathered = malloc(n * sizeof(int64_t));
  forces = calloc(3 * n, sizeof(double));
  gathered = malloc(3 * n * sizeof(double));
  double shortest[kNumCalls];
  for (int k = 0; k < kNumCalls; ++k) shortest[k] = 1e9;
  check(barchan_run(sim, 1000, NULL));
  for (int r = 0; r < repetitions; ++r) {
    for (int k = 0; k < kNumCalls; ++k) {
      take_ids();
      const double begin = now();
      kCalls[k].work();
      const double seconds = (now() - begin) / (k == 0 ? kStepsAtATime : 1);
      if (seconds < shortest[k]) shortest[k] = seconds;
    }
  }
  for (int k = 0; k < kNumCalls; ++k) {
    printf("%s\"%s\": %.9g", k == 0 ? "{" : ", ", kCalls[k].name, shortest[k]);
  }
  printf("}\n");
  fprintf(stderr, "%g\n", sums[0]); /* so that it is computed */
  check(barchan_close(sim));
  return 0;
}
