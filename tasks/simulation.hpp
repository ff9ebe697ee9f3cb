#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <barchan/comm/auto_exchange.hpp>
#include <barchan/comm/communicator.hpp>
#include <barchan/comm/exchange.hpp>
#include <barchan/core/departure.hpp>
#include <barchan/core/measures.hpp>
#include <barchan/core/model.hpp>
#include <barchan/core/walls.hpp>
#include <barchan/tasks/run_options.hpp>

namespace barchan {

/// One owned particle as callers see it. Positions are those of time(), velocities half a step
/// earlier (leapfrog).
struct OwnedParticle {
  std::int64_t id;
  std::int32_t type;    ///< material index
  double radius, mass;  ///< mass of a fixed particle: infinite
  Vec3 position, velocity, omega;
};

/// One kind of communication of this rank [s].
struct CommunicationTime {
  double in_flight = 0.0;  ///< under way
  double exposed = 0.0;    ///< of that, not spent on particles: waiting, or inside the exchange; a
                           ///< worker's, averaged
  double late = 0.0;       ///< of exposed: waits while the neighbour had not sent yet; known where
                           ///< both share a node, and so a clock
};

/// Where the time of a run went, this rank; what workers do side by side is averaged over them.
struct Timings {
  double loop_seconds = 0.0;             ///< inside run()
  std::int64_t steps = 0;                ///< of this loop; what came before a restart is not in it
  std::map<std::string, double> phases;  ///< name → seconds; the rest of the loop is "other"
  std::map<std::string, CommunicationTime> communication;  ///< "halo", "rebuild", "reductions"
  double in_flight_seconds = 0.0;                          ///< all kinds
  double exposed_seconds = 0.0;
  std::int64_t rebuilds = 0, migrations = 0;
  ExchangeStats exchange;  ///< zero on one rank
};

/// Something that happened in a run and that its log should say.
struct Note {
  std::string text;  ///< a line
  bool is_warning = false;
};

/// What left the domain since the start, and the links that went with it.
struct LeftDomain {
  std::int64_t particles = 0;
  LinkCounts links;
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
/// (comm/call_watch.hpp).
/// Construction, run, measure, digest, destruction and what is said to be are collective; the rest
/// is local. One thread at a time.
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
  /// Goes on from a checkpoint, bit for bit, on any number of ranks and threads and with any
  /// exchange.
  /// @param model       of the run that wrote it; length and outputs may differ
  /// @param checkpoint  its folder; see find_checkpoint
  /// Errors, the same on every rank: InputError when it is damaged or of another model
  static Simulation restore(const Model& model, const std::string& checkpoint,
                            Communicator communicator, const RunOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Advances by at most `num_steps`; fewer when a stop was requested or the last stage ends.
  /// @return steps done
  /// Errors: AgreedError, the same on every rank and between two steps: a particle left the domain
  /// and must not, overlaps beyond the limit, a particle or wall outran the skin, particles,
  /// contacts or bonds got lost. RunError on one rank only: a particle that in one step moves
  /// farther than half the skin or is no longer finite, a wait without end. A run that failed
  /// throws the same again; after an AgreedError the state can still be read and saved.
  /// std::logic_error for calls that cannot be: fewer than 0 steps, from within run(), after the
  /// simulation was moved from. RunError once MPI has ended.
  std::int64_t run(std::int64_t num_steps);
  /// Ends the run() of this process that is under way, or else its next one, on all ranks and
  /// within a few steps; then the request is forgotten. Callable from a signal handler.
  static void request_stop() noexcept;
  /// All ranks agreed to stop the last run(), after which the next goes on; or is_over().
  [[nodiscard]] bool stopped() const;
  [[nodiscard]] bool is_over() const;  ///< the last stage has ended, and with it the run

  [[nodiscard]] std::int64_t step() const;
  [[nodiscard]] double time() const;  ///< [s]
  [[nodiscard]] int stage() const;    ///< index into Model::stages
  [[nodiscard]] const Model& model() const;
  [[nodiscard]] const RunOptions& options() const;  ///< threads filled in
  [[nodiscard]] std::string vector_width() const;   ///< in use
  [[nodiscard]] const Communicator& communicator() const;

  /// Calls `visit` for every particle that this rank owns, in canonical order.
  void for_each_owned(const std::function<void(const OwnedParticle&)>& visit) const;
  [[nodiscard]] std::int64_t num_owned() const;
  [[nodiscard]] std::int64_t num_particles() const;     ///< on all ranks, now
  [[nodiscard]] const LeftDomain& left_domain() const;  ///< on all ranks; local
  /// Calls `tell` on rank 0, within run(), with particles that left the domain, in order of their
  /// ids: before they are removed, or before run() throws. What it throws every rank throws.
  void on_departure(std::function<void(std::span<const Departure>)> tell);
  /// What happened on this rank since the last call; what all ranks know is told by rank 0. Local.
  [[nodiscard]] std::vector<Note> take_notes();
  /// Sets a force [N] on every owned particle, added in every step until it is set again or
  /// cleared.
  void apply_forces(const std::function<Vec3(const OwnedParticle&)>& force);
  void clear_forces();

  /// Energies, contacts, largest overlap, momentum; over all ranks. Collective.
  [[nodiscard]] Measures measure();
  /// Walls as they stand; force, torque and work as of the last measure(). Local.
  [[nodiscard]] std::span<const WallState> walls() const;
  /// State digest over all ranks (design: same bits everywhere). Collective.
  [[nodiscard]] std::uint64_t digest();

  /// From now on run() saves the state to `folder` as `spec` says, and when a checkpoint is
  /// requested; the newest spec.keep stay. A checkpoint is copied between two steps and written
  /// behind the next ones; see CheckpointKeeper. It holds the state at the beginning of a step, so
  /// whatever is written after run() returned comes first. Collective.
  void keep_checkpoints(const std::string& folder, const CheckpointSpec& spec);
  /// Saves the state as it is, unless it just was; finish_checkpoints() waits for it. Collective.
  /// @pre keep_checkpoints()
  void save_checkpoint();
  /// Waits for what is being written. @return false, on all ranks, when the last one is not on the
  /// disk. Collective.
  bool finish_checkpoints();
  /// Saves soon, on all ranks when one asks for it. Callable from a signal handler.
  static void request_checkpoint() noexcept;
  /// Checkpoints that could not be written, since the last call. On rank 0; local.
  [[nodiscard]] std::vector<std::string> take_checkpoint_warnings();
  /// The folder of the newest complete one of this run, at first that which it goes on from; empty:
  /// none. On rank 0, empty elsewhere; local.
  [[nodiscard]] std::string last_checkpoint() const;

  [[nodiscard]] Timings timings() const;
  /// Which exchange is in use and why; the same on every rank.
  [[nodiscard]] const ExchangeChoice& exchange_choice() const;
  /// The step graph of all ranks as DOT, for Graphviz; complete on rank 0. Collective.
  [[nodiscard]] std::string step_graph() const;
  /// What happened when, as Chrome trace events of all ranks; opens in Perfetto. Collective.
  /// @pre RunOptions::trace. Errors: RunError when the file cannot be written.
  void write_trace(const std::string& path) const;
  [[nodiscard]] double skin() const;
  [[nodiscard]] std::size_t memory_bytes() const;  ///< particles, lists, history of this rank

 private:
  class Engine;
  template <int Dim>
  class EngineOf;
  explicit Simulation(std::unique_ptr<Engine> engine);
  [[nodiscard]] Engine& engine() const;
  [[nodiscard]] Engine& between_steps(const char* call) const;  ///< where `call` may be made
  std::unique_ptr<Engine> engine_;
};

/// Names that RunOptions::exchange takes, the default first: `auto`, those of comm, the published
/// scheme `return`. With a tape that plays, `replay` and no other.
std::vector<std::string> exchange_choices();

}  // namespace barchan
