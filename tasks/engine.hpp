#pragma once

#include <exception>
#include <memory>
#include <string>

#include <barchan/core/brick/link_force.hpp>
#include <barchan/core/checkpoint/state.hpp>
#include <barchan/tasks/checkpoint_keeper.hpp>
#include <barchan/tasks/checkpoint_load.hpp>
#include <barchan/tasks/growth_watch.hpp>
#include <barchan/tasks/lists_keeper.hpp>
#include <barchan/tasks/particle_index.hpp>
#include <barchan/tasks/plates.hpp>
#include <barchan/tasks/rebuild_schedule.hpp>
#include <barchan/tasks/run_parts.hpp>
#include <barchan/tasks/simulation.hpp>
#include <barchan/tasks/stages.hpp>
#include <barchan/tasks/state_data.hpp>
#include <barchan/tasks/step_graph.hpp>
#include <barchan/tasks/threads.hpp>
#include <barchan/tasks/view.hpp>
#include <barchan/tasks/watch.hpp>

namespace barchan {

/// Simulation's inside, free of the dimension.
class Simulation::Engine : public BrickSource {
 public:
  ~Engine() override { generation_.end(); }
  virtual std::int64_t run(std::int64_t num_steps) = 0;
  virtual void for_each_owned(const std::function<void(const OwnedParticle&)>& visit) const = 0;
  virtual void for_each_bond(const BondVisitor& visit) = 0;
  virtual void apply_forces(const std::function<Vec3(const OwnedParticle&)>& force) = 0;
  virtual void clear_forces() = 0;
  virtual Measures measure() = 0;
  virtual std::uint64_t digest() = 0;
  [[nodiscard]] virtual std::span<const WallState> walls() const = 0;
  [[nodiscard]] virtual Timings timings() const = 0;
  [[nodiscard]] virtual CutsInUse cuts() const = 0;
  [[nodiscard]] virtual GraphShape graph_shape() const = 0;
  [[nodiscard]] virtual std::size_t memory_bytes() const = 0;
  [[nodiscard]] virtual std::int64_t num_owned() const = 0;
  [[nodiscard]] virtual std::string vector_width() const = 0;
  [[nodiscard]] virtual double skin() const = 0;
  [[nodiscard]] virtual double force_grain() const = 0;
  virtual void save_checkpoint() = 0;
  // What other solvers call between steps (library_calls.cpp).
  [[nodiscard]] virtual int num_bricks() const = 0;
  virtual std::vector<ParticleView> owned() = 0;
  virtual std::vector<LoadView> loads() = 0;
  virtual std::shared_ptr<const void> release_arrays() = 0;
  [[nodiscard]] virtual std::int64_t highest_id() = 0;
  virtual void for_each_view(const std::function<void(const ParticleView&)>& visit) = 0;
  virtual void set_loads(const Loads& loads) = 0;
  virtual Gathered gather(ParticleField field) = 0;
  virtual void scatter(ParticleField field, std::span<const std::int64_t> ids,
                       std::span<const double> values) = 0;
  virtual void keep_breaks() = 0;  ///< where somebody wants to hear of them
  virtual void add_field(const std::string& name, int components) = 0;
  virtual std::vector<FieldView> field(const CallerField& field) = 0;
  virtual Gathered gather(const CallerField& field) = 0;
  virtual void scatter(const CallerField& field, std::span<const std::int64_t> ids,
                       std::span<const double> values) = 0;
  virtual void add(const ParticleSet& newcomers) = 0;
  virtual void remove(std::span<const std::int64_t> ids) = 0;
  virtual void set_gravity(const Vec3& gravity) = 0;
  virtual void set_time_step(double dt) = 0;
  virtual void set_contacts(const ContactTable& contacts) = 0;
  /// One step, shorter than others, that ends then. @return 1, or 0 as run()
  virtual std::int64_t run_short(double time) = 0;
  virtual void set_wall_velocity(std::size_t wall, const Vec3& velocity) = 0;
  virtual void set_wall_load(std::size_t wall, double load) = 0;
  /// @param normal  of length 1
  virtual void set_wall_pose(std::size_t wall, const Vec3& point, const Vec3& normal) = 0;
  virtual std::vector<LinkForce> links(LinkKind kind) = 0;
  virtual void save(std::unique_ptr<State::Data>& state) = 0;
  virtual void load(const State::Data& state) = 0;

  [[nodiscard]] double time() const { return since_.at(step_, model_.time.step); }  ///< [s]

  /// Fills in how many threads there are. Collective.
  Engine(const Model& model, Communicator communicator, RunOptions options)
      : model_(model), options_(std::move(options)), communicator_(std::move(communicator)) {
    communicator_.set_tape(options_.tape);
    if (options_.threads <= 0) options_.threads = default_threads(communicator_);
  }

  friend class Simulation;
  friend class WallControl;

 protected:
  Model model_;
  RunOptions options_;
  Communicator communicator_;
  std::int64_t step_ = 0;
  TimePoint since_;  ///< of time()
  Stages stages_{model_};
  Population population_;
  /// run() is in a callback of the caller's.
  enum class Telling { Nothing, OnOneThread, OnAllThreads };
  template <class Work>
  void tell(const char* event, Telling how, Work&& work);

  Telling telling_ = Telling::Nothing;
  RunEvents events_;
  bool stopped_ = false;
  bool has_new_contacts_ = false;  ///< somebody has called set_contact
  bool has_account_ = false;       ///< of energy, where one is kept
  bool is_over_ = false;           ///< the last stage is
  bool is_in_step_ = false;        ///< or one was not ended
  std::exception_ptr failure_;     ///< what run() threw
  std::string restored_from_;      ///< checkpoint; empty: a new run
  ExchangeChoice choice_;
  std::unique_ptr<Trace> trace_;  ///< null: no trace
  std::unique_ptr<CheckpointKeeper> keeper_;
  Notes notes_;
  Generation generation_;
  ParticleIndex index_;
  CallerFields fields_;
};

/// The time loop: what comes between two steps, and who does it. One step itself is StepGraph.
///
///     checkpoint due? ─► stage over? ─► answer of the last check ─► lists ─► next check ─► steps
template <int Dim>
class Simulation::EngineOf final : public Simulation::Engine {
 public:
  EngineOf(const Model& model, const ParticleSet& particles, Communicator communicator,
           const RunOptions& options);
  EngineOf(const Model& model, const OpenCheckpoint& checkpoint, Communicator communicator,
           const RunOptions& options);
  ~EngineOf() override;

  std::int64_t run(std::int64_t num_steps) override;
  void for_each_owned(const std::function<void(const OwnedParticle&)>& visit) const override {
    barchan::for_each_owned(parts_.strip, visit);
  }
  void for_each_bond(const BondVisitor& visit) override {
    barchan::for_each_bond(parts_.strip, visit);
  }
  void apply_forces(const std::function<Vec3(const OwnedParticle&)>& force) override {
    barchan::apply_forces(parts_.strip, force);
  }
  void clear_forces() override {
    for (Lane<Dim>& lane : parts_.strip.lanes()) lane.brick.store.external.clear();
    generation_.advance();
  }
  Measures measure() override;
  void begin_account();
  std::uint64_t digest() override { return barchan::digest(parts_.strip); }
  [[nodiscard]] std::span<const WallState> walls() const override { return parts_.world.walls; }
  [[nodiscard]] Timings timings() const override;
  [[nodiscard]] CutsInUse cuts() const override;
  [[nodiscard]] GraphShape graph_shape() const override { return graph_.shape(); }
  [[nodiscard]] std::size_t memory_bytes() const override { return parts_.strip.bytes(); }
  [[nodiscard]] std::int64_t num_owned() const override { return parts_.strip.num_owned(); }
  [[nodiscard]] std::string vector_width() const override {
    return name_of(parts_.world.kernels.width);
  }
  [[nodiscard]] double skin() const override { return parts_.world.skin; }
  [[nodiscard]] double force_grain() const override { return parts_.world.grain.size; }
  void save_checkpoint() override;
  [[nodiscard]] int num_bricks() const override { return parts_.strip.num_lanes(); }
  std::vector<ParticleView> owned() override;
  LoadView loads_of(int brick) override;
  StridedSpan<double> field_of(int brick, const std::string& name) override;
  void keep_breaks() override;
  std::vector<LoadView> loads() override;
  std::shared_ptr<const void> release_arrays() override;
  [[nodiscard]] std::int64_t highest_id() override;
  void for_each_view(const std::function<void(const ParticleView&)>& visit) override;
  void set_loads(const Loads& loads) override;
  Gathered gather(ParticleField field) override;
  void scatter(ParticleField field, std::span<const std::int64_t> ids,
               std::span<const double> values) override;
  void add_field(const std::string& name, int components) override;
  std::vector<FieldView> field(const CallerField& field) override;
  Gathered gather(const CallerField& field) override;
  void scatter(const CallerField& field, std::span<const std::int64_t> ids,
               std::span<const double> values) override;
  void add(const ParticleSet& newcomers) override;
  void remove(std::span<const std::int64_t> ids) override;
  void set_gravity(const Vec3& gravity) override;
  void set_time_step(double dt) override;
  void set_contacts(const ContactTable& contacts) override;
  std::int64_t run_short(double time) override;
  void set_wall_velocity(std::size_t wall, const Vec3& velocity) override;
  void set_wall_load(std::size_t wall, double load) override;
  void set_wall_pose(std::size_t wall, const Vec3& point, const Vec3& normal) override;
  std::vector<LinkForce> links(LinkKind kind) override;
  void save(std::unique_ptr<State::Data>& state) override;
  void load(const State::Data& state) override;

 private:
  EngineOf(const Model& model, Communicator communicator, const RunOptions& options,
           const WorldScale& scale);
  void begin_loop();
  /// Steps that a decision of all ranks may take (engine_shadows.cpp).
  [[nodiscard]] static int lag_of(const RunParts<Dim>& run);
  void tell_shadows_forces();
  std::int64_t go_on(std::int64_t most);
  void prepare_step();
  [[nodiscard]] bool last_stage_ends();
  [[nodiscard]] bool stage_is_over();
  void update_lists();
  void begin_check();
  [[nodiscard]] int steps_in_a_go(std::int64_t most);
  [[nodiscard]] CheckpointState state();
  void renew_lists();
  void check_step(const Model& wanted);
  void take_contacts(const ContactTable& contacts);
  /// Books what springs hold more after change() as given by the caller. Collective.
  void book_elastic(const std::function<void()>& change);
  void turn_wall(std::size_t wall, const Vec3& normal);
  [[nodiscard]] ParticleView view_of(int brick);
  void visit_step();
  void tell_progress();
  void tell_news();
  [[nodiscard]] std::vector<BondBreak> gather_breaks();
  [[nodiscard]] const ParticleIndex& index();
  /// Of this rank, others have lane < 0. Collective. Errors: InputError for an id that there is not
  [[nodiscard]] std::vector<ParticlePlace> find_all(std::span<const std::int64_t> ids,
                                                    const char* call);
  /// Books the kinetic energy of what is of this rank as work of callers. Local.
  /// @param share  -1 before a caller changes it, 1 after
  void book_kinetic(std::span<const ParticlePlace> places, double share);

  RunParts<Dim> parts_;
  StepGraph<Dim> graph_;
  RebuildSchedule schedule_;
  ListsKeeper<Dim> lists_;
  Watch<Dim> watch_;
  GrowthWatch growth_;
  Plates plates_;
  LoopSeconds loop_;
  bool had_forces_ = false;  ///< of callers, in the last run
};

}  // namespace barchan
