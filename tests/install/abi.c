/* The C ABI from plain C: wrong calls are refused in words, and roll-backs leave no trace. Prints the
 * digest, which no flag of this program's own compiler may change. */
#include <barchan.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

static void expect(int is_right, const char* what) {
  if (is_right) return;
  fprintf(stderr, "abi: %s (last error: '%s')\n", what, barchan_error());
  ++failures;
}

static void expect_error(int code, int wanted, const char* words) {
  if (code == wanted && strstr(barchan_error(), words) != NULL) return;
  fprintf(stderr, "abi: code %d instead of %d, '%s' instead of '%s'\n", code, wanted,
          barchan_error(), words);
  ++failures;
}

static void push(barchan_sim* sim, double force) {
  barchan_info info;
  expect(barchan_get_info(sim, &info) == BARCHAN_OK, "info");
  for (int b = 0; b < info.num_bricks; ++b) {
    barchan_loads loads;
    expect(barchan_get_loads(sim, b, &loads) == BARCHAN_OK, "loads");
    for (int64_t i = 0; i < loads.size; ++i) {
      loads.forces[i * loads.stride + 1] = force;
      loads.torques_by_radius[i * loads.stride] = 0.5 * force;
    }
  }
}

static void wrong_calls(barchan_sim* sim, const char* deck, int comm) {
  barchan_sim* none = NULL;
  const int64_t id = 1000000;
  const double zeros[3] = {0.0, 0.0, 0.0};
  expect_error(barchan_run(NULL, 1, NULL), BARCHAN_WRONG_CALL, "NULL");
  expect_error(barchan_run((barchan_sim*)zeros, 1, NULL), BARCHAN_WRONG_CALL, "no such simulation");
  expect_error(barchan_run(sim, -1, NULL), BARCHAN_WRONG_CALL, "-1 steps");
  expect_error(barchan_open("no.toml", NULL, comm, &none), BARCHAN_WRONG_INPUT, "no.toml");
  expect_error(barchan_open(NULL, NULL, comm, &none), BARCHAN_WRONG_CALL, "NULL");
  expect_error(barchan_open(deck, "time.stepp=1", comm, &none), BARCHAN_WRONG_INPUT, "stepp");
  expect_error(barchan_open(deck, "--thread=1", comm, &none), BARCHAN_WRONG_INPUT, "--thread=1");
  expect_error(barchan_open(deck, "--threads=x", comm, &none), BARCHAN_WRONG_INPUT, "no number");
  expect_error(barchan_open(deck, NULL, 123456, &none), BARCHAN_WRONG_INPUT, "123456");
  expect_error(barchan_open_text("dimension = 4", NULL, comm, &none), BARCHAN_WRONG_INPUT, "deck");
  expect(none == NULL, "a simulation was made from a wrong deck");
  expect_error(barchan_set_loads(sim, 1, &id, zeros, NULL), BARCHAN_WRONG_CALL, "1000000");
  expect_error(barchan_set_loads(sim, 1, &id, NULL, NULL), BARCHAN_WRONG_CALL, "NULL");
  expect_error(barchan_scatter(sim, BARCHAN_FORCE, 1, &id, zeros), BARCHAN_WRONG_INPUT, "1000000");
  expect_error(barchan_scatter(sim, 99, 1, &id, zeros), BARCHAN_WRONG_CALL, "field");
  expect_error(barchan_remove(sim, 1, &id), BARCHAN_WRONG_INPUT, "1000000");
  expect_error(barchan_set_wall_load(sim, "lid", 1.0), BARCHAN_WRONG_CALL, "'floor'");
  expect_error(barchan_load(sim, NULL), BARCHAN_WRONG_CALL, "state");
  barchan_view view;
  expect_error(barchan_get_view(sim, 99, BARCHAN_RADIUS, &view), BARCHAN_WRONG_CALL, "brick");
  expect_error(barchan_get_view(sim, 0, BARCHAN_FORCE, &view), BARCHAN_WRONG_CALL, "no array");
  expect_error(barchan_get_view(sim, 0, BARCHAN_RADIUS, NULL), BARCHAN_WRONG_CALL, "NULL");
  expect_error(barchan_set_time_step(sim, 1.0), BARCHAN_WRONG_INPUT, "unstable");
  expect_error(barchan_set_wall_pose(sim, "floor", NULL, NULL), BARCHAN_WRONG_CALL, "NULL");
  expect_error(barchan_set_wall_pose(sim, "floor", zeros, zeros), BARCHAN_WRONG_INPUT, "no length");
  expect_error(barchan_set_contact(sim, "sand", "gold", ""), BARCHAN_WRONG_CALL, "gold");
  expect_error(barchan_set_contact(sim, "sand", "sand", "mu=1"), BARCHAN_WRONG_INPUT, "'mu'");
  expect_error(barchan_get_links(sim, 7, 0, NULL, NULL), BARCHAN_WRONG_CALL, "kind");
  int major = -1;
  barchan_abi(&major, NULL);
  expect(major == BARCHAN_ABI_MAJOR, "the library is of another ABI");
}

/* A field of the program's own and loads from callbacks; steps are counted and one ends a run. */
typedef struct {
  barchan_sim* sim;
  int64_t progress, stop_at;
} course;

static int visit(void* user, const barchan_brick* brick) {
  barchan_loads loads;
  barchan_values dose;
  barchan_view velocity;
  const int64_t* ids = NULL;
  int64_t size = 0;
  (void)user;
  if (barchan_brick_loads(brick, &loads) != BARCHAN_OK) return 1;
  if (barchan_brick_field(brick, "dose", &dose) != BARCHAN_OK) return 2;
  if (barchan_brick_view(brick, BARCHAN_VELOCITY, &velocity) != BARCHAN_OK) return 3;
  if (barchan_brick_ids(brick, &ids, &size) != BARCHAN_OK || size != dose.size) return 4;
  for (int64_t i = 0; i < size; ++i) {
    dose.data[i * dose.stride] += 1.0;
    loads.forces[i * loads.stride] = -0.1 * velocity.data[i * velocity.stride];
  }
  return barchan_brick_field(brick, "none", &dose) == BARCHAN_WRONG_CALL ? 0 : 5;
}

static int progress(void* user, int64_t step, double time) {
  course* c = user;
  barchan_info info;
  if (barchan_get_info(c->sim, &info) != BARCHAN_OK || info.step != step || info.time != time)
    return 1;
  if (barchan_measure(c->sim, NULL) != BARCHAN_WRONG_CALL) return 2;
  if (barchan_run(c->sim, 1, NULL) != BARCHAN_WRONG_CALL) return 3;
  if (barchan_close(c->sim) != BARCHAN_WRONG_CALL) return 4;
  ++c->progress;
  return step == c->stop_at ? 77 : 0;
}

static void callbacks(barchan_sim* sim) {
  barchan_info info;
  barchan_state* before = NULL;
  course c = {sim, 0, -1};
  expect_error(barchan_add_field(sim, "no name", 1), BARCHAN_WRONG_INPUT, "no name");
  expect_error(barchan_get_field(sim, 0, "dose", NULL), BARCHAN_WRONG_CALL, "none");
  expect_error(barchan_get_field(sim, 0, NULL, NULL), BARCHAN_WRONG_CALL, "NULL");
  expect_error(barchan_on_progress(sim, 0, progress, &c), BARCHAN_WRONG_INPUT, "every 0 steps");
  expect(barchan_add_field(sim, "dose", 1) == BARCHAN_OK, "add_field");
  expect(barchan_on_step(sim, 4, visit, NULL) == BARCHAN_OK, "on_step");
  expect(barchan_on_progress(sim, 10, progress, &c) == BARCHAN_OK, "on_progress");
  expect(barchan_run(sim, 40, NULL) == BARCHAN_OK, "a run with callbacks");
  expect(c.progress == 4, "progress");
  expect(barchan_save(sim, &before) == BARCHAN_OK, "save");
  expect(barchan_get_info(sim, &info) == BARCHAN_OK, "info");
  c.stop_at = info.step + 20;
  expect_error(barchan_run(sim, 40, NULL), BARCHAN_RUN_ENDED, "the callback returned 77");
  expect(barchan_load(sim, before) == BARCHAN_OK, "load after a callback's end");
  expect(barchan_free_state(before) == BARCHAN_OK, "free");
  expect(barchan_on_step(sim, 1, NULL, NULL) == BARCHAN_OK, "no on_step");
  expect(barchan_on_progress(sim, 1, NULL, NULL) == BARCHAN_OK, "no on_progress");
  expect(barchan_clear_loads(sim) == BARCHAN_OK, "clear");
  int64_t* ids = malloc(sizeof *ids * (size_t)info.num_particles);
  double* doses = malloc(sizeof *doses * (size_t)info.num_particles);
  int64_t count = -1;
  expect(barchan_gather_field(sim, "dose", info.num_particles, ids, doses, &count) == BARCHAN_OK,
         "gather_field");
  for (int64_t i = 0; i < count; ++i) expect(doses[i] == 10.0, "a dose");
  const int64_t two[] = {7, 3};
  const double values[] = {1.0, 2.0};
  expect(barchan_scatter_field(sim, "dose", 2, two, values) == BARCHAN_OK, "scatter_field");
  expect(barchan_gather_field(sim, "dose", info.num_particles, ids, doses, &count) == BARCHAN_OK,
         "gather_field");
  if (count > 0) expect(doses[2] == 2.0 && doses[6] == 1.0, "scattered values");
  free(ids);
  free(doses);
}

/* Contacts with the floor, and steps of other lengths. */
static void press(barchan_sim* sim) {
  const double below[3] = {0.0, -0.002, 0.0};
  int64_t count = 0, again = 0;
  expect(barchan_set_wall_pose(sim, "floor", below, NULL) == BARCHAN_OK, "set_wall_pose");
  expect(
      barchan_set_contact(sim, "sand", "sand", "friction=0.1\nnormal_stiffness=1e5") == BARCHAN_OK,
      "set_contact");
  expect(barchan_set_time_step(sim, 1.5e-4) == BARCHAN_OK, "set_time_step");
  expect(barchan_advance_to(sim, 0.0401, NULL) == BARCHAN_OK, "advance_to");
  double normal[3] = {0.0, 0.0, 0.0};
  expect(barchan_get_wall_normal(sim, "floor", normal) == BARCHAN_OK && normal[1] == 1.0, "normal");
  expect_error(barchan_get_wall_normal(sim, "lid", normal), BARCHAN_WRONG_CALL, "'floor'");
  barchan_info info;
  expect(barchan_get_info(sim, &info) == BARCHAN_OK && info.time == 0.0401, "the time itself");
  expect(barchan_get_links(sim, BARCHAN_CONTACT, 0, NULL, &count) == BARCHAN_OK, "how many links");
  barchan_link* links = malloc((size_t)(count + 1) * sizeof *links);
  expect(barchan_get_links(sim, BARCHAN_CONTACT, count, links, &again) == BARCHAN_OK, "links");
  expect(count == again, "two counts of links");
  for (int64_t k = 0; k < again; ++k) {
    expect(links[k].first < links[k].second && links[k].overlap > 0.0, "a link");
    expect(links[k].normal_force >= 0.0, "a contact that pulls");
  }
  free(links);
}

int main(int argc, char** argv) {
  int level = 0, rank = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const int comm = (int)MPI_Comm_c2f(MPI_COMM_WORLD);
  barchan_sim* sim = NULL;
  expect(barchan_open(argv[1], "particles.1.seed=3\n--threads=2", comm, &sim) == BARCHAN_OK,
         "open");
  if (sim == NULL) MPI_Abort(MPI_COMM_WORLD, 1);
  wrong_calls(sim, argv[1], comm);

  barchan_state* state = NULL;
  for (int k = 0; k < 5; ++k) {
    expect(barchan_save(sim, &state) == BARCHAN_OK, "save");
    push(sim, -0.5);
    expect(barchan_run(sim, 7 * k, NULL) == BARCHAN_OK, "an excursion");
    expect(barchan_load(sim, state) == BARCHAN_OK, "load");
    push(sim, 0.25);
    int64_t done = 0;
    expect(barchan_run(sim, 20, &done) == BARCHAN_OK && done == 20, "run");
  }
  callbacks(sim);
  press(sim);
  expect(barchan_free_state(state) == BARCHAN_OK, "free");
  expect_error(barchan_load(sim, state), BARCHAN_WRONG_CALL, "no such state");
  uint64_t digest = 0;
  expect(barchan_digest(sim, &digest) == BARCHAN_OK, "digest");
  expect(barchan_close(sim) == BARCHAN_OK, "close");
  expect_error(barchan_run(sim, 1, NULL), BARCHAN_WRONG_CALL, "closed");
  if (rank == 0) printf("%016llx\n", (unsigned long long)digest);
  MPI_Allreduce(MPI_IN_PLACE, &failures, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  MPI_Finalize();
  return failures == 0 ? 0 : 1;
}
