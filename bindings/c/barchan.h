/* barchan for C, and for whatever can call C (docs/library.md).
 *
 *     barchan_sim* sim = NULL;
 *     if (barchan_open("bed.toml", "time.step=1e-5\n--threads=2", comm, &sim) != BARCHAN_OK)
 *       die(barchan_error());
 *     barchan_run(sim, 100, NULL);
 *     barchan_close(sim);
 *
 * MPI is the caller's; `comm` is the handle of a communicator as Fortran has it, an integer;
 * docs/library.md says how to get it. All ranks of the communicator make the calls marked [all], in
 * the same order; the others are local. A simulation takes calls of one thread at a time. Every
 * call returns one of the codes below; barchan_error() gives the text of an error. Units are SI;
 * vectors have three components, in 2D too, unless a view says otherwise.
 */
#ifndef BARCHAN_H
#define BARCHAN_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of this header; barchan_version() is that of the library. A program runs with any library of the
 * same major version that is not older. */
#define BARCHAN_ABI_MAJOR 0
#define BARCHAN_ABI_MINOR 2

enum barchan_code {
  BARCHAN_OK = 0,
  BARCHAN_WRONG_INPUT = 1, /* the same on every rank; nothing has changed */
  BARCHAN_WRONG_CALL = 2,  /* of this rank; nothing has changed */
  BARCHAN_RUN_ENDED = 3,   /* on every rank between two steps: the state can be read, saved, or
                              replaced by barchan_load */
  BARCHAN_FAILED = 4       /* perhaps on this rank only, while others wait: end all ranks */
};

typedef struct barchan_sim barchan_sim;
typedef struct barchan_state barchan_state;

/* The text of this thread's last error; empty: there was none. Stands until its next error. */
const char* barchan_error(void);
const char* barchan_version(void); /* such as "0.1.0" */
void barchan_abi(int* major, int* minor);

/* For programs without an MPI of their own: starts it unless it runs, and ends it at exit. */
int barchan_start_mpi(void);
int barchan_world(void); /* the handle of the communicator of all ranks */

/* ---- from a deck to its end
 * settings: one a line, NULL or empty for none: `key=value` as --set has them, and `--threads=2`,
 * `--exchange=put-flag`, `--vector=avx2`, `--schedule=sequential`. checkpoint: its folder, or one
 * of several, of which the newest is taken. Each [all]. */
int barchan_open(const char* deck, const char* settings, int comm, barchan_sim** sim);
int barchan_open_text(const char* toml, const char* settings, int comm, barchan_sim** sim);
int barchan_restore(const char* deck, const char* settings, const char* checkpoint, int comm,
                    barchan_sim** sim);
int barchan_write_checkpoint(barchan_sim* sim, const char* folder); /* [all] */
int barchan_close(barchan_sim* sim); /* [all]; ends its views; states are still to be freed */

/* done: steps done, or NULL. Each [all]. */
int barchan_run(barchan_sim* sim, int64_t steps, int64_t* done);
/* Until it is `time` [s]: whole steps, and a shorter last one where one is needed. */
int barchan_advance_to(barchan_sim* sim, double time, int64_t* done);
int barchan_set_time_step(barchan_sim* sim, double step); /* of steps from now on [s] */

typedef struct {
  double time, step_length; /* [s] */
  int64_t step, num_particles, num_owned;
  uint64_t generation; /* changes whenever views end */
  int32_t dimension, num_bricks, num_walls, stage, stopped;
} barchan_info;
int barchan_get_info(barchan_sim* sim, barchan_info* info);

typedef struct {
  double kinetic, elastic, gravitational; /* [J] */
  double momentum[3];                     /* [N s] */
  double max_overlap, max_speed;          /* [m], [m/s] */
  int64_t contacts, bonds, broken_bonds;
} barchan_measures;
int barchan_measure(barchan_sim* sim, barchan_measures* measures); /* [all] */
int barchan_digest(barchan_sim* sim, uint64_t* digest);            /* [all] */

/* ---- arrays of this rank, brick by brick, where barchan has them
 * Component c of particle i is data[i * stride + c], c < width. They show the newest state until
 * the generation changes; then ask for them anew. */
enum barchan_field {
  BARCHAN_POSITION = 0,
  BARCHAN_VELOCITY = 1,         /* half a step behind positions */
  BARCHAN_ANGULAR_VELOCITY = 2, /* gather and scatter only */
  BARCHAN_FORCE = 3,            /* the caller's load; gather and scatter only */
  BARCHAN_TORQUE = 4,           /* the same */
  BARCHAN_RADIUS = 5,
  BARCHAN_MASS = 6,          /* gather only */
  BARCHAN_TYPE = 7,          /* gather only; index of the material, from 0 */
  BARCHAN_SURFACE_SPEED = 8, /* radius * angular velocity; views only, as what follows */
  BARCHAN_INVERSE_MASS = 9,  /* of a fixed particle 0 */
  BARCHAN_DENSITY = 10
};
typedef struct {
  const double* data;
  int64_t size, stride;
  int32_t width;
} barchan_view;
typedef struct {
  double* forces;            /* [N]; component c of particle i: forces[i * stride + c] */
  double* torques_by_radius; /* torque / radius [N]; one component in 2D, about z */
  int64_t size, stride;
} barchan_loads;
int barchan_get_view(barchan_sim* sim, int brick, int field, barchan_view* view);
int barchan_get_ids(barchan_sim* sim, int brick, const int64_t** ids, int64_t* size);
int barchan_get_types(barchan_sim* sim, int brick, const uint8_t** types, int64_t* size);
int barchan_get_loads(barchan_sim* sim, int brick, barchan_loads* loads);

/* Contacts or bonds that count on this rank, with the forces that the next step finds in them. A
 * copy, in any order. links: NULL, or with `room` for so many; count: how many there are. [all] */
enum barchan_link_kind { BARCHAN_CONTACT = 0, BARCHAN_WALL_CONTACT = 1, BARCHAN_BOND = 2 };
typedef struct {
  int64_t first, second;      /* ids; of a contact with a wall its number in the deck, from 0 */
  double normal[3];           /* from the first to the second */
  double overlap;             /* [m]; of a bond by how much it is shorter than unstressed */
  double normal_force;        /* above zero it pushes apart [N] */
  double tangential_force[3]; /* on the first [N] */
} barchan_link;
int barchan_get_links(barchan_sim* sim, int kind, int64_t room, barchan_link* links,
                      int64_t* count);

/* ---- by id; torques may be NULL: zeros */
int barchan_set_loads(barchan_sim* sim, int64_t count, const int64_t* ids, const double* forces,
                      const double* torques);
int barchan_clear_loads(barchan_sim* sim);
/* A field of all particles in order of ids, on rank 0, into arrays of `room` particles; ids and
 * values may be NULL. count: how many there are, on rank 0. [all] */
int barchan_gather(barchan_sim* sim, int field, int64_t room, int64_t* ids, double* values,
                   int64_t* count);
/* Velocities, angular velocities, forces or torques, the same lists on every rank. [all] */
int barchan_scatter(barchan_sim* sim, int field, int64_t count, const int64_t* ids,
                    const double* values);

/* ---- changes in the course, the same on every rank; each [all] */
typedef struct {
  int64_t id;             /* from 1 */
  int32_t type, fixed;    /* material, from 0; 1: never moves */
  double radius, density; /* [m], [kg/m3], in 2D [kg/m2] */
  double position[3], velocity[3], omega[3];
} barchan_particle;
int barchan_add(barchan_sim* sim, int64_t count, const barchan_particle* particles);
int barchan_remove(barchan_sim* sim, int64_t count, const int64_t* ids);
int barchan_set_gravity(barchan_sim* sim, const double gravity[3]);
/* What two materials have together; numbers: one a line, such as "friction=0.3", under the keys of
 * a deck. Others stay. */
int barchan_set_contact(barchan_sim* sim, const char* a, const char* b, const char* numbers);
int barchan_set_wall_velocity(barchan_sim* sim, const char* wall, const double velocity[3]);
int barchan_set_wall_load(barchan_sim* sim, const char* wall, double load);
/* Elsewhere at once; normal: NULL to keep it. */
int barchan_set_wall_pose(barchan_sim* sim, const char* wall, const double point[3],
                          const double normal[3]);

typedef struct {
  double point[3], velocity[3];
  double force[3], torque[3], work; /* of the last barchan_measure */
  int32_t is_active;
} barchan_wall;
int barchan_get_wall(barchan_sim* sim, const char* wall, barchan_wall* state); /* local */

/* ---- states in memory; *state NULL at first, later its memory is used again. Each [all]. */
int barchan_save(barchan_sim* sim, barchan_state** state);
int barchan_load(barchan_sim* sim, const barchan_state* state);
int barchan_free_state(barchan_state* state); /* local */

#ifdef __cplusplus
}
#endif
#endif
