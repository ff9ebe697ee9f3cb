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
 *
 * Errors of every call, beside those named at it: BARCHAN_WRONG_CALL: a handle that is NULL, was
 * closed or never opened, NULL where something is needed, a count below 0, a call from another
 * thread while one is under way, from within a callback that may not make it, or after a run that
 * failed; BARCHAN_FAILED: MPI, memory or another rank failed.
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
#define BARCHAN_ABI_MINOR 3

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
 * of several, of which the newest is taken. Each [all].
 * Errors: BARCHAN_WRONG_INPUT: a deck, a setting or a checkpoint that is wrong or differs between
 * ranks, with file, line and remedy */
int barchan_open(const char* deck, const char* settings, int comm, barchan_sim** sim);
int barchan_open_text(const char* toml, const char* settings, int comm, barchan_sim** sim);
int barchan_restore(const char* deck, const char* settings, const char* checkpoint, int comm,
                    barchan_sim** sim);
/* The present state, at once. [all] Errors: BARCHAN_FAILED, on every rank: it is not on the disk */
int barchan_write_checkpoint(barchan_sim* sim, const char* folder);
/* From now on barchan_run writes checkpoints behind the steps: every so many steps and every so
 * many seconds (0: not by these), of which the newest `keep` stay; 1 or more. [all]
 * Errors: BARCHAN_WRONG_INPUT: a number below 0, none to keep */
int barchan_keep_checkpoints(barchan_sim* sim, const char* folder, int64_t every_steps,
                             double every_seconds, int keep);
int barchan_close(barchan_sim* sim); /* [all]; ends its views; states are still to be freed */

/* ---- callbacks within barchan_run, between two steps, on the thread that called it; user is
 * handed on. One that returns anything but 0 ends the run on every rank between the same two
 * steps: BARCHAN_RUN_ENDED, with the rank and the value in the text. Meanwhile barchan_get_...,
 * but links, barchan_set_loads and barchan_clear_loads may be called; from barchan_on_step's and
 * departures' none. Each replaces the former one; NULL ends it. All but departures [all]; a rank
 * may give NULL while others do not.
 * Errors: BARCHAN_WRONG_INPUT: every below 1, or not the same on every rank */
typedef struct barchan_brick barchan_brick; /* the particles of one brick, while it is visited */
typedef struct {
  int64_t step, id_a, id_b; /* in which step; the lower id first */
} barchan_bond_break;
typedef struct {
  int64_t step, id;
  double position[3], velocity[3]; /* [m], [m/s] */
} barchan_departure;
/* Before every step whose number is a multiple of `every`, for every brick, on as many threads as
 * there are: loads written here act in this step. */
int barchan_on_step(barchan_sim* sim, int64_t every,
                    int (*visit)(void* user, const barchan_brick* brick), void* user);
/* After such steps, on every rank. */
int barchan_on_progress(barchan_sim* sim, int64_t every,
                        int (*tell)(void* user, int64_t step, double time), void* user);
/* What follows is told after every 16th step and at the end of barchan_run. On the rank that it is
 * of; rank 0 has what all know: */
int barchan_on_note(barchan_sim* sim, int (*tell)(void* user, const char* text, int is_warning),
                    void* user);
/* On rank 0. folder: where it is, "" where it could not be written; error: "" or what went wrong */
int barchan_on_checkpoint(barchan_sim* sim,
                          int (*tell)(void* user, int64_t step, const char* folder,
                                      const char* error),
                          void* user);
int barchan_on_bond_breaks(barchan_sim* sim,
                           int (*tell)(void* user, int64_t count, const barchan_bond_break* breaks),
                           void* user);
/* On rank 0, when particles leave the domain and before they are removed; local. */
int barchan_on_departure(barchan_sim* sim,
                         int (*tell)(void* user, int64_t count, const barchan_departure* left),
                         void* user);

/* done: steps done, or NULL. Each [all].
 * Errors: BARCHAN_RUN_ENDED: such as a particle out of the domain, an overlap beyond the limit, a
 * callback's end: the same again until barchan_load; BARCHAN_WRONG_CALL: steps below 0 */
int barchan_run(barchan_sim* sim, int64_t steps, int64_t* done);
/* Until it is `time` [s]: whole steps, and a shorter last one where one is needed.
 * Errors: as barchan_run; BARCHAN_WRONG_CALL: a time that has passed; BARCHAN_WRONG_INPUT: not the
 * same on every rank, or not finite */
int barchan_advance_to(barchan_sim* sim, double time, int64_t* done);
/* Of steps from now on [s]. [all]
 * Errors: BARCHAN_WRONG_INPUT: not above 0, unstable, or not the same on every rank */
int barchan_set_time_step(barchan_sim* sim, double step);

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
 * the generation changes; then ask for them anew. Local.
 * Errors: BARCHAN_WRONG_CALL: no such brick, a field that is no array */
enum barchan_field {
  BARCHAN_POSITION = 0,         /* [m] */
  BARCHAN_VELOCITY = 1,         /* half a step behind positions [m/s] */
  BARCHAN_ANGULAR_VELOCITY = 2, /* gather and scatter only [rad/s] */
  BARCHAN_FORCE = 3,            /* the caller's load; gather and scatter only [N] */
  BARCHAN_TORQUE = 4,           /* the same, about the centre [N m] */
  BARCHAN_RADIUS = 5,           /* [m] */
  BARCHAN_MASS = 6,             /* gather only; of a fixed particle infinite [kg] */
  BARCHAN_TYPE = 7,             /* gather only; index of the material, from 0 */
  BARCHAN_SURFACE_SPEED = 8,    /* radius * angular velocity; views only, as what follows [m/s] */
  BARCHAN_INVERSE_MASS = 9,     /* of a fixed particle 0 [1/kg] */
  BARCHAN_DENSITY = 10,         /* [kg/m3], in 2D [kg/m2] */
  BARCHAN_TEMPERATURE = 11      /* gather and scatter only; where the deck has [heat] [K] */
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
/* The same of the brick that barchan_on_step's callback visits. */
int barchan_brick_view(const barchan_brick* brick, int field, barchan_view* view);
int barchan_brick_ids(const barchan_brick* brick, const int64_t** ids, int64_t* size);
int barchan_brick_types(const barchan_brick* brick, const uint8_t** types, int64_t* size);
int barchan_brick_loads(const barchan_brick* brick, barchan_loads* loads);

/* Contacts or bonds that count on this rank, with the forces that the next step finds in them. A
 * copy, in any order. links: NULL, or with `room` for so many; count: how many there are. [all]
 * Errors: BARCHAN_WRONG_CALL: no such kind, no room */
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

/* ---- by id; forces [N] and torques about centres [N m], three a particle; torques NULL: zeros.
 * Others keep their loads. Local.
 * Errors: BARCHAN_WRONG_CALL, and nothing is set: an id that is not on this rank, a number that is
 * not finite */
int barchan_set_loads(barchan_sim* sim, int64_t count, const int64_t* ids, const double* forces,
                      const double* torques);
int barchan_clear_loads(barchan_sim* sim); /* of this rank; local */
/* A field of all particles in order of ids, on rank 0, into arrays of `room` particles; ids and
 * values may be NULL. count: how many there are, on rank 0. Three values a particle, but one of a
 * radius, mass, type or temperature. [all] Errors: BARCHAN_WRONG_CALL: no such field, no room */
int barchan_gather(barchan_sim* sim, int field, int64_t room, int64_t* ids, double* values,
                   int64_t* count);
/* Velocities, angular velocities, forces or torques, three values a particle, or temperatures, one
 * each; the same lists on every rank. [all]
 * Errors: BARCHAN_WRONG_INPUT, and nothing is set: lists that differ, an id that there is not, a
 * fixed particle that is to move, a number that is not finite, temperatures without [heat] */
int barchan_scatter(barchan_sim* sim, int field, int64_t count, const int64_t* ids,
                    const double* values);

/* ---- fields of the caller's own: numbers of every particle that travel with it, through states
 * and checkpoints, and that barchan never reads; 0 at first, and of newcomers. name: letters,
 * digits and _. A field that is there, as after barchan_restore, keeps its values. [all]
 * Errors: BARCHAN_WRONG_INPUT: no name, other components than the field has, more than 256 numbers */
int barchan_add_field(barchan_sim* sim, const char* name, int components);
typedef struct {
  double* data; /* component c of particle i: data[i * stride + c]; until the generation changes */
  int64_t size, stride;
  int32_t width;
} barchan_values;
/* Errors, here and below: BARCHAN_WRONG_CALL: there is no such field */
int barchan_get_field(barchan_sim* sim, int brick, const char* name, barchan_values* values);
int barchan_brick_field(const barchan_brick* brick, const char* name, barchan_values* values);
/* As barchan_gather and barchan_scatter, with as many numbers a particle as components. [all] */
int barchan_gather_field(barchan_sim* sim, const char* name, int64_t room, int64_t* ids,
                         double* values, int64_t* count);
int barchan_scatter_field(barchan_sim* sim, const char* name, int64_t count, const int64_t* ids,
                          const double* values);

/* ---- changes in the course, the same on every rank; each [all] */
typedef struct {
  int64_t id;                                /* from 1 */
  int32_t type, fixed;                       /* material, from 0; 1: never moves */
  double radius, density;                    /* [m], [kg/m3], in 2D [kg/m2] */
  double position[3], velocity[3], omega[3]; /* [m], [m/s], [rad/s]; half a step behind the place */
} barchan_particle;
/* Errors: BARCHAN_WRONG_INPUT, and nothing is added: an id that is taken, no room there, larger
 * than the largest of the start, too light or small for the step */
int barchan_add(barchan_sim* sim, int64_t count, const barchan_particle* particles);
/* With contacts and bonds.
 * Errors: BARCHAN_WRONG_INPUT, and nothing is removed: an id that there is not, or that is named
 * twice */
int barchan_remove(barchan_sim* sim, int64_t count, const int64_t* ids);
/* [m/s2]. Errors: BARCHAN_WRONG_INPUT: not finite, or along z in 2D */
int barchan_set_gravity(barchan_sim* sim, const double gravity[3]);
/* What two materials have together; numbers: one a line, such as "friction=0.3", under the keys of
 * a deck. Others stay. Errors: BARCHAN_WRONG_CALL: no such material, a value that is no number;
 * BARCHAN_WRONG_INPUT: no such key, a value without a meaning, a step that would be too long */
int barchan_set_contact(barchan_sim* sim, const char* a, const char* b, const char* numbers);
/* From the next step on [m/s]. Errors, here and below: BARCHAN_WRONG_CALL: no such wall;
 * BARCHAN_WRONG_INPUT: it is moved by its load */
int barchan_set_wall_velocity(barchan_sim* sim, const char* wall, const double velocity[3]);
/* Of a loaded plate, along its normal [N/m2]. Errors: BARCHAN_WRONG_INPUT: it is not loaded */
int barchan_set_wall_load(barchan_sim* sim, const char* wall, double load);
/* Elsewhere at once [m]; normal: of any length, NULL to keep it.
 * Errors: BARCHAN_WRONG_INPUT, and nothing is changed: a particle would reach into it by more than
 * half of its radius, a normal without a length */
int barchan_set_wall_pose(barchan_sim* sim, const char* wall, const double point[3],
                          const double normal[3]);

typedef struct {
  double point[3], velocity[3];     /* [m], [m/s] */
  double force[3], torque[3], work; /* of the last barchan_measure [N], [N m], [J] */
  int32_t is_active;
} barchan_wall;
int barchan_get_wall(barchan_sim* sim, const char* wall, barchan_wall* state);     /* local */
int barchan_get_wall_normal(barchan_sim* sim, const char* wall, double normal[3]); /* local; unit */

/* ---- states in memory; *state NULL at first, later its memory is used again. Each [all].
 * Errors: BARCHAN_WRONG_CALL: a state that was freed, is empty or of another simulation */
int barchan_save(barchan_sim* sim, barchan_state** state);
int barchan_load(barchan_sim* sim, const barchan_state* state);
int barchan_free_state(barchan_state* state); /* local */

#ifdef __cplusplus
}
#endif
#endif
