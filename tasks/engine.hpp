#pragma once

#include <exception>
#include <memory>
#include <optional>

#include <barchan/tasks/checkpoint_keeper.hpp>
#include <barchan/tasks/checkpoint_load.hpp>
#include <barchan/tasks/exchange_setup.hpp>
#include <barchan/tasks/plates.hpp>
#include <barchan/tasks/rebuild_schedule.hpp>
#include <barchan/tasks/simulation.hpp>
#include <barchan/tasks/skin_tuner.hpp>
#include <barchan/tasks/step_graph.hpp>
#include <barchan/tasks/strip.hpp>
#include <barchan/tasks/world_setup.hpp>

namespace barchan {

/// Simulation's inside, free of the dimension.
class Simulation::Engine {
 public:
  virtual ~Engine() = default;
  virtual std::int64_t run(std::int64_t num_steps) = 0;
  virtual void for_each_owned(const std::function<void(const OwnedParticle&)>& visit) const = 0;
  virtual void for_each_bond(const BondVisitor& visit) = 0;
  virtual void apply_forces(const std::function<Vec3(const OwnedParticle&)>& force) = 0;
  virtual void clear_forces() = 0;
  virtual Measures measure() = 0;
  virtual std::uint64_t digest() = 0;
  [[nodiscard]] virtual std::span<const WallState> walls() const = 0;
  [[nodiscard]] virtual Timings timings() const = 0;
  [[nodiscard]] virtual GraphShape graph_shape() const = 0;
  [[nodiscard]] virtual std::size_t memory_bytes() const = 0;
  [[nodiscard]] virtual std::int64_t num_owned() const = 0;
  [[nodiscard]] virtual std::string vector_width() const = 0;
  [[nodiscard]] virtual double skin() const = 0;
  [[nodiscard]] virtual double force_grain() const = 0;

  virtual void save_checkpoint() = 0;

  Engine(const Model& model, Communicator communicator, RunOptions options)
      : model_(model), options_(std::move(options)), communicator_(std::move(communicator)) {
    communicator_.set_tape(options_.tape);
  }

  const Model model_;
  RunOptions options_;
  Communicator communicator_;
  std::int64_t step_ = 0;
  std::int64_t num_particles_ = 0;
  int stage_ = 0;
  bool stopped_ = false;
  bool is_over_ = false;        ///< the last stage is
  bool is_in_step_ = false;     ///< or one was not ended
  std::exception_ptr failure_;  ///< what run() threw
  std::string restored_from_;   ///< checkpoint; empty: a new run
  ExchangeChoice choice_;
  std::unique_ptr<Trace> trace_;  ///< null: no trace
  std::unique_ptr<CheckpointKeeper> keeper_;
  LeftDomain left_;
  std::function<void(std::span<const Departure>)> tell_departures_;
  std::vector<Note> notes_;
};

/// The time loop: when to rebuild, which stage it is, how walls move. One step itself is StepGraph.
template <int Dim>
class Simulation::EngineOf final : public Simulation::Engine {
 public:
  EngineOf(const Model& model, const ParticleSet& particles, Communicator communicator,
           const RunOptions& options);

  EngineOf(const Model& model, const std::string& checkpoint, Communicator communicator,
           const RunOptions& options);

  ~EngineOf() override;
  std::int64_t run(std::int64_t num_steps) override;
  void for_each_owned(const std::function<void(const OwnedParticle&)>& visit) const override;
  void for_each_bond(const BondVisitor& visit) override;
  void apply_forces(const std::function<Vec3(const OwnedParticle&)>& force) override;
  void clear_forces() override;
  Measures measure() override;
  std::uint64_t digest() override;
  [[nodiscard]] std::span<const WallState> walls() const override { return world_.walls; }
  [[nodiscard]] Timings timings() const override;
  [[nodiscard]] GraphShape graph_shape() const override { return graph_->shape(); }
  [[nodiscard]] std::size_t memory_bytes() const override { return strip_->bytes(); }
  [[nodiscard]] std::int64_t num_owned() const override { return strip_->num_owned(); }
  [[nodiscard]] std::string vector_width() const override { return name_of(world_.kernels.width); }
  [[nodiscard]] double skin() const override { return world_.skin; }
  [[nodiscard]] double force_grain() const override { return world_.grain.size; }
  void save_checkpoint() override;

 private:
  void make_world(const WorldScale& scale);
  void make_strip();  ///< without particles
  void make_loop();
  void restore(const OpenCheckpoint& checkpoint);
  void restore_particles(const OpenCheckpoint& checkpoint);
  void check_restored(const OpenCheckpoint& checkpoint);
  [[nodiscard]] CheckpointState state();
  void keep_checkpoints();
  [[nodiscard]] bool wants_checkpoint() const;
  void make_trace();
  std::int64_t go_on(std::int64_t most);
  [[nodiscard]] int steps_in_a_go(std::int64_t most);
  void stop_if_wrong();
  void update_lists();
  [[nodiscard]] double next_skin() const;
  void size_chunks();
  void press_plates(const StepFrame& frame);
  void kick_plates();
  void update_stage();
  void enter_stage(int stage);
  void refuse_intruders(std::size_t wall);
  [[nodiscard]] bool is_last_stage() const;
  [[nodiscard]] bool last_stage_ends();
  [[nodiscard]] bool stage_time_is_over(std::int64_t step) const;
  [[nodiscard]] bool stage_may_end(std::int64_t step) const;
  [[nodiscard]] bool stage_is_over();
  [[nodiscard]] CheckNumbers check_numbers();
  // engine_watch.cpp
  [[nodiscard]] Travel travel() const;
  [[nodiscard]] bool is_harmless(const CheckNumbers& answer) const;
  void judge(const CheckNumbers& answer);
  void judge_balance(const CheckNumbers& answer);
  void judge_overlap(double share);
  [[nodiscard]] std::vector<Departure> departures();
  void remove_outside();
  void watch_overlap();
  void watch_growth();
  void watch_plates() const;
  [[nodiscard]] double top_speed() const;
  [[nodiscard]] double wall_distance2() const;
  // engine_report.cpp
  void note(std::string text, bool is_warning = false);
  void note_departures(const std::vector<Departure>& left, std::int64_t contacts,
                       std::int64_t bonds);
  [[noreturn]] void report_outrun(const CheckNumbers& answer);
  [[noreturn]] void report_departures(const std::vector<Departure>& departures);
  [[noreturn]] void report_fast(int lane);
  [[noreturn]] void report_passage(const Passage& passage) const;
  [[nodiscard]] std::string remedy_for_travel(double travel) const;
  [[noreturn]] void report_overload(int lane);
  [[nodiscard]] std::string describe(const WorstOverlap& worst) const;
  [[nodiscard]] std::string describe(const Suspect& suspect,
                                     const typename Lane<Dim>::Partners& touched) const;
  [[nodiscard]] typename Lane<Dim>::Partners partners_of(const Suspect& suspect);
  [[nodiscard]] std::string describe_fastest();
  [[nodiscard]] std::string describe_worst_overlap();
  [[nodiscard]] std::string from_rank_with_most(double mine, const std::string& text);
  [[nodiscard]] OwnedParticle particle(const ParticleStore<Dim>& store, std::int32_t i) const;

  World<Dim> world_;
  std::unique_ptr<Strip<Dim>> strip_;
  std::unique_ptr<StepGraph<Dim>> graph_;
  std::unique_ptr<RebuildSchedule> schedule_;
  std::optional<SkinTuner> tuner_;  ///< of rank 0
  double tuned_skin_ = 0.0;         ///< that all ranks agreed on [m]
  std::unique_ptr<Plates> plates_;
  std::vector<WallSums> plate_sums_;  ///< of this rank, in a step
  std::vector<Vec3> walls_at_rebuild_;
  std::int64_t stage_begin_ = 0;
  bool must_rebuild_ = false;
  bool must_save_ = false;               ///< all ranks agreed to
  bool must_remove_ = false;             ///< particles out of the domain
  double overlap_ = 0.0;                 ///< largest share seen since the last check
  bool has_warned_ = false;              ///< of overlap
  std::vector<std::size_t> sizes_;       ///< of buffers, as last told
  std::int64_t overlap_watched_at_ = 0;  ///< step
  WorldScale scale_;
  double chunk_seconds_ = 0.0;  ///< of chunks when they were last sized
  std::int64_t chunks_sized_at_ = 0;
  std::int64_t loop_steps_ = 0;
  double loop_seconds_ = 0.0, rebuild_seconds_ = 0.0, checkpoint_seconds_ = 0.0;
};

}  // namespace barchan
