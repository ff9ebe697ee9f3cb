#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/comm/probe/auto_exchange.hpp>
#include <barchan/comm/slots/exchange.hpp>
#include <barchan/core/brick/departure.hpp>
#include <barchan/core/brick/link_force.hpp>
#include <barchan/core/brick/measures.hpp>
#include <barchan/core/links/walls.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/core/particles/caller_fields.hpp>
#include <barchan/tasks/notes.hpp>
#include <barchan/tasks/particle_view.hpp>
#include <barchan/tasks/run_events.hpp>
#include <barchan/tasks/run_options.hpp>
#include <barchan/tasks/state.hpp>
#include <barchan/tasks/wall_control.hpp>

namespace barchan {

/// One owned particle as callers see it. Positions are those of time(), velocities half a step
/// earlier (leapfrog).
struct OwnedParticle : ParticleData {
  double mass = 0.0;  ///< [kg]; of a fixed particle infinite
};

using BondVisitor = std::function<void(const BondData&, const Vec3& a, const Vec3& b)>;

/// Times of one kind of communication on this rank [s].
struct CommunicationTime {
  double in_flight = 0.0;  ///< messages were under way
  double exposed = 0.0;    ///< a worker waited or was inside the exchange; mean over the workers
  double late = 0.0;       ///< part of exposed: the neighbour had not sent yet; known only where
                           ///< both share a node, and so a clock
};

/// Where the time of a run went on this rank; means over its workers.
struct Timings {
  double loop_seconds = 0.0;             ///< inside run()
  std::int64_t steps = 0;                ///< of this loop, without those before a restart
  std::map<std::string, double> phases;  ///< name → seconds; they sum up to loop_seconds
  std::vector<double> worked;            ///< by lane: seconds in tasks of steps, without waiting
  std::map<std::string, CommunicationTime> communication;  ///< "halo", "rebuild", "reductions"
  double in_flight_seconds = 0.0;                          ///< all kinds
  double exposed_seconds = 0.0;
  std::int64_t rebuilds = 0, migrations = 0;
  ExchangeStats exchange;  ///< zero on one rank
};

/// How ranks, and the lanes of each for its threads, share the domain: so many along x, y and z.
struct CutsInUse {
  bool are_strips = true;
  std::array<int, 3> ranks{1, 1, 1}, lanes{1, 1, 1};
  int depth = 0;  ///< of shadows beyond each cut between ranks
};

/// A DEM simulation on all ranks of a communicator.
///
///     Simulation sim(model, particles, Communicator::world(), options);
///     while (sim.time() < end) {
///       sim.apply_forces([](const OwnedParticle& p) { return Vec3(-0.1 * p.velocity); });
///       sim.run(10);
///     }
///
/// The state is the same to the bit for any number of ranks, threads and any exchange. The library
/// works on a communicator of its own and prints nothing. It ends the program in one case, with a
/// line on stderr: this rank cannot come back from a call of MPI, since another rank hangs
/// (comm/base/call_watch.hpp).
/// Construction, run, measure, digest, destruction and members documented as collective are
/// collective; the rest is local. One thread at a time.
class Simulation {
 public:
  /// @param particles     all of them, the same on every rank
  /// @param communicator  the ranks that own the strips; a caller's own handle is duplicated
  /// Errors: InputError, the same on every rank, for a model that cannot run (validate.hpp, an
  /// unstable step, too many ranks for the domain, gross overlaps, unknown exchange or vector
  /// width), for input that differs between ranks, and for more threads than MPI's thread level
  /// allows.
  Simulation(const Model& model, const ParticleSet& particles, Communicator communicator,
             const RunOptions& options = {});
  /// Continues from a checkpoint, bit for bit, on any number of ranks and threads and with any
  /// exchange.
  /// @param model       of the run that wrote it; length and outputs may differ
  /// @param checkpoint  its folder; see find_checkpoint
  /// Errors, the same on every rank: InputError when the checkpoint is damaged or of another model
  static Simulation restore(const Model& model, const std::string& checkpoint,
                            Communicator communicator, const RunOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Advances by at most `num_steps`; fewer when a stop was requested or the last stage ends.
  /// @return steps done
  /// Errors: AgreedError, the same on every rank and between two steps: a particle left a domain
  /// that it may not leave, an overlap is beyond the limit, a particle or wall moved farther than
  /// half the skin between rebuilds, particles, contacts or bonds are missing. RunError on one rank
  /// only: a particle moved farther than half the skin in one step or is no longer finite, or
  /// another rank did not answer. A run that failed throws the same again; after an AgreedError the
  /// state can still be read and saved. std::logic_error for calls that are not possible: fewer
  /// than 0 steps, from within run(), after the simulation was moved from. RunError once MPI has
  /// ended.
  std::int64_t run(std::int64_t num_steps);
  /// Runs until it is `time` [s]: whole steps, and then a shorter one where one is needed. A time
  /// that is within a millionth of a step counts as that step. As run(), and the same on every
  /// rank. @return steps done
  /// The state is the same to the bit for the same times on any ranks; a shorter step is a step
  /// like others, so it is another state than without (docs/library.md).
  /// Errors: std::invalid_argument: `time` has passed. InputError: ranks give different times, or
  /// one that is not finite
  std::int64_t advance_to(double time);
  /// The length of steps from now on [s]. Collective; the same on every rank.
  /// Errors: InputError, and nothing is changed: not above 0, or unstable
  void set_time_step(double dt);
  /// Ends the run() of this process that is under way, or else its next one, on all ranks and
  /// within a few steps; then the request is forgotten. Callable from a signal handler.
  static void request_stop() noexcept;
  /// All ranks agreed to stop the last run(), and the next one continues; or is_over().
  [[nodiscard]] bool stopped() const;
  [[nodiscard]] bool is_over() const;  ///< the last stage has ended, and with it the run

  [[nodiscard]] bool is_in_callback() const;  ///< of run()
  [[nodiscard]] std::int64_t step() const;
  [[nodiscard]] double time() const;  ///< [s]
  [[nodiscard]] int stage() const;    ///< index into Model::stages
  [[nodiscard]] const Model& model() const;
  [[nodiscard]] const RunOptions& options() const;  ///< threads filled in
  [[nodiscard]] std::string vector_width() const;   ///< in use
  [[nodiscard]] const Communicator& communicator() const;

  /// Calls `visit` for every particle that this rank owns, in any order.
  void for_each_owned(const std::function<void(const OwnedParticle&)>& visit) const;
  /// Calls `visit` for every whole bond, on one rank each, with the positions of its ends; that of
  /// b by the image nearest to a. Collective.
  void for_each_bond(const BondVisitor& visit);
  [[nodiscard]] std::int64_t num_owned() const;
  [[nodiscard]] std::int64_t num_particles() const;     ///< on all ranks, now
  [[nodiscard]] const LeftDomain& left_domain() const;  ///< on all ranks; local
  /// Events on this rank since the last call; rank 0 has those that all ranks know. Local.
  [[nodiscard]] std::vector<Note> take_notes();

  // ---- callbacks within run(), between two steps. What one throws on some rank ends the run on
  // every rank, between the same two steps, with one AgreedError that has its words. They are
  // called on the thread that called run(), on_step's on all threads. Meanwhile owned(), loads(),
  // field(), set_loads(), apply_forces() and what only tells may be called, from on_step's nothing
  // but the view; all else is std::logic_error. Each replaces the former one; an empty one ends it.
  // Collective but for on_departure; a rank may give an empty one while others do not. `every`: 1
  // or more, the same on every rank, else InputError.
  /// Before every step whose number is a multiple of `every`: for the view of every brick, on as
  /// many threads as there are. Loads that it writes act in this step. Costs a reduction each time.
  void on_step(std::int64_t every, std::function<void(const ParticleView&)> visit);
  /// The same, with the views of all bricks of this rank at once.
  void on_step_together(std::int64_t every,
                        std::function<void(std::span<const ParticleView>)> visit);
  /// After such steps, on every rank.
  void on_progress(std::int64_t every, std::function<void(const RunProgress&)> tell);
  /// Instead of take_notes(). After every 16th step and before run() returns, as what follows.
  void on_note(std::function<void(const Note&)> tell);
  /// On rank 0: checkpoints that are complete, or could not be written.
  void on_checkpoint(std::function<void(const CheckpointEvent&)> tell);
  /// On rank 0: bonds that broke, in order of steps and ids; those on all ranks.
  void on_bond_breaks(std::function<void(std::span<const BondBreak>)> tell);
  /// On rank 0, with particles that left the domain, in order of their ids: before they are
  /// removed, or before run() throws. Nothing may be called but what only tells.
  void on_departure(std::function<void(std::span<const Departure>)> tell);

  /// Sets a force [N] on every owned particle, added in every step until it is set again or
  /// cleared.
  void apply_forces(const std::function<Vec3(const OwnedParticle&)>& force);
  void clear_forces();

  // ---- for other solvers (docs/library.md); between steps
  /// The particles of this rank, a view for each of its bricks, without a copy. Local.
  [[nodiscard]] std::vector<ParticleView> owned();
  [[nodiscard]] int num_bricks() const;  ///< of this rank: as many views as owned() gives
  /// Changes whenever views end: rows moved, or loads were cleared. Local.
  [[nodiscard]] std::uint64_t generation() const;
  /// Ends all views, and gives away the memory that they show; the simulation goes on in a copy. So
  /// whoever keeps the result can read their spans on, as values of this moment. Local.
  [[nodiscard]] std::shared_ptr<const void> release_arrays();
  /// The highest id on all ranks; 0: there is none. Collective.
  [[nodiscard]] std::int64_t highest_id();
  /// Calls `visit` for the view of every brick, on as many threads as there are. Local.
  void for_each_view(const std::function<void(const ParticleView&)>& visit);
  /// Loads to write in place, brick by brick as owned(). Local.
  [[nodiscard]] std::vector<LoadView> loads();
  /// Sets loads on these particles of this rank; others keep theirs. They act in every step until
  /// they are set again or cleared. In the order of owned() it is fastest. Local.
  /// Errors: std::invalid_argument, and nothing is set: an id of another rank, lengths that do not
  /// fit, a number that is not finite
  void set_loads(const Loads& loads);
  /// A field of all particles, on rank 0; empty elsewhere. Collective.
  /// Errors: InputError: temperatures of a model without heat
  [[nodiscard]] Gathered gather(ParticleField field);
  /// Sets velocities, angular velocities, forces, torques or temperatures of any particles.
  /// @param ids, values  the same on every rank; three numbers a particle, of temperatures one.
  /// Collective.
  /// Errors: InputError, the same on every rank, and nothing is set: an id that there is not, a
  /// fixed particle that is to move, other lengths, a number that is not finite
  void scatter(ParticleField field, std::span<const std::int64_t> ids,
               std::span<const double> values);
  /// A field of the caller's own: so many numbers of every particle, which travel with it through
  /// rebuilds, states and checkpoints, and which barchan never reads. They are 0 at first, and of
  /// newcomers. Collective; the same on every rank.
  /// @param name  letters, digits and _
  /// @return false: there is such a field, as after a restart, and it keeps its values
  /// Errors: InputError, and nothing is changed: no name, components below 1 or other ones than the
  /// field has, more numbers a particle than CallerFields allows
  bool add_field(const std::string& name, int components = 1);
  [[nodiscard]] const std::vector<CallerField>& fields() const;
  /// Such a field, to read and write in place, brick by brick as owned(). Local.
  /// Errors: std::invalid_argument, here and below: there is no such field
  [[nodiscard]] std::vector<FieldView> field(const std::string& name);
  [[nodiscard]] Gathered gather(const std::string& field);  ///< as above. Collective.
  /// As above; as many numbers a particle as the field has components. Collective.
  void scatter(const std::string& field, std::span<const std::int64_t> ids,
               std::span<const double> values);
  /// Particles that come now, with velocities half a step behind their positions, no larger than
  /// the largest of the start. @param newcomers  the same on every rank. Collective.
  /// Errors: InputError, the same on every rank, and nothing is added: an id that is taken, a place
  /// where a particle or wall is, one for which the step is too long, or as check_particles finds
  void add(std::span<const ParticleData> newcomers);
  /// Particles that go now, with their contacts and bonds. @param ids  the same on every rank.
  /// Collective. Errors: InputError, the same on every rank, and nothing is removed: an id that
  /// there is not, or that is named twice
  void remove(std::span<const std::int64_t> ids);
  /// From the next step on [m/s²]. Collective; the same on every rank.
  void set_gravity(const Vec3& gravity);
  /// What two materials have together from the next step on; both orders of names are the same.
  /// Springs of contacts stay. Collective; the same on every rank.
  /// @param constants  such as a changed copy of model().contacts.at(a, b)
  /// Errors: std::invalid_argument: no material has the name. InputError, and nothing is changed:
  /// the step would be too long, or contacts would hold farther beyond touch than at the start
  void set_contact(const std::string& a, const std::string& b, const ContactConstants& constants);
  /// What they have now. Errors: std::invalid_argument: no material has the name
  [[nodiscard]] const ContactConstants& contact(const std::string& a, const std::string& b) const;
  /// The wall of this name: wall("lid").set_velocity(v). Errors: std::invalid_argument: none has it
  [[nodiscard]] WallControl wall(const std::string& name);

  /// The present state, in memory. Collective.
  [[nodiscard]] State save();
  void save(State& state);  ///< the same, in the memory of a former one. Collective.
  /// All is as it was when `state` was saved, to the bit. Notes, timings, callbacks and files stay.
  /// After an AgreedError, too. Collective. Errors: std::logic_error: an empty state, or one of
  /// another simulation
  void load(const State& state);

  /// Contacts or bonds that count on this rank, in any order, and the forces that the next step
  /// will find in them; over all ranks each is listed once. A copy. Collective.
  [[nodiscard]] std::vector<LinkForce> links(LinkKind kind);
  /// Energies, contacts, largest overlap, momentum; over all ranks. Collective.
  [[nodiscard]] Measures measure();
  /// Where energy has come from and gone to, of what measure() gave at this step. Local.
  /// Errors: InputError without Model::output.energy
  [[nodiscard]] EnergyBudget energy_budget(const Measures& measured) const;
  /// Walls at this step; force, torque and work as of the last measure(). Local.
  [[nodiscard]] std::span<const WallState> walls() const;
  /// Digest of the state of all ranks (docs/determinism.md). Collective.
  [[nodiscard]] std::uint64_t digest();

  /// From now on run() saves the state to `folder` at the intervals of `spec` and on request, and
  /// keeps the newest spec.keep checkpoints. It copies the state between two steps and writes it
  /// behind the next ones; see CheckpointKeeper. A checkpoint has the state at the beginning of a
  /// step, so results of that step should be written before the next run(). Collective.
  void keep_checkpoints(const std::string& folder, const CheckpointSpec& spec);
  /// Saves the present state, unless it is saved; finish_checkpoints() waits for it. Collective.
  /// @pre keep_checkpoints()
  void save_checkpoint();
  /// Waits until checkpoints are written. @return false, on all ranks, when the last one is not on
  /// the disk. Collective.
  bool finish_checkpoints();
  /// Makes all ranks save the state within some steps. Callable from a signal handler.
  static void request_checkpoint() noexcept;
  /// Checkpoints that could not be written, since the last call. On rank 0; local.
  [[nodiscard]] std::vector<std::string> take_checkpoint_warnings();
  /// The folder of the newest complete one of this run, at first that which it goes on from; empty:
  /// none. On rank 0, empty elsewhere; local.
  [[nodiscard]] std::string last_checkpoint() const;

  [[nodiscard]] Timings timings() const;
  /// Which exchange is in use and why; the same on every rank.
  [[nodiscard]] const ExchangeChoice& exchange_choice() const;
  [[nodiscard]] CutsInUse cuts() const;  ///< the same on every rank
  /// The step graph of all ranks as DOT, for Graphviz; complete on rank 0. Collective.
  [[nodiscard]] std::string step_graph() const;
  /// Writes tasks, messages and waits of all ranks as Chrome trace events. Collective.
  /// @pre RunOptions::trace. Errors: RunError when the file cannot be written.
  void write_trace(const std::string& path) const;
  [[nodiscard]] double skin() const;
  [[nodiscard]] double force_grain() const;        ///< of this run [N], see ForceGrain
  [[nodiscard]] std::size_t memory_bytes() const;  ///< particles, lists, history of this rank

 private:
  friend class WallControl;
  class Engine;
  template <int Dim>
  class EngineOf;
  explicit Simulation(std::unique_ptr<Engine> engine);
  [[nodiscard]] Engine& engine() const;
  [[nodiscard]] Engine& between_steps(const char* call) const;  ///< where `call` may be made
  [[nodiscard]] Engine& at_rest(const char* call) const;        ///< callbacks may, too
  std::unique_ptr<Engine> engine_;
};

/// The values of RunOptions::exchange, the default first: `auto`, those of comm, and the published
/// scheme `return`. A tape that plays needs `replay`.
std::vector<std::string> exchange_choices();

}  // namespace barchan
