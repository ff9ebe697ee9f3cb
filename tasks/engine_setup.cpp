#include <algorithm>
#include <cmath>

#include <barchan/comm/topology/strips.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/check_walls.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/tasks/engine.hpp>
#include <barchan/tasks/forecast.hpp>
#include <barchan/tasks/stability.hpp>
#include <barchan/tasks/strip_plan.hpp>
#include <barchan/tasks/threads.hpp>

namespace barchan {

template <int Dim>
Simulation::EngineOf<Dim>::EngineOf(const Model& model, const ParticleSet& particles,
                                    Communicator communicator, const RunOptions& options)
    : Engine(model, std::move(communicator), options) {
  check_particles(model_, particles);
  check_walls(model_, particles);
  check_time_step(model_, step_limits(model_, particles));
  check_precision(model_, particles);
  num_particles_ = static_cast<std::int64_t>(particles.particles.size());
  const double skin = model_.search.skin.value_or(default_skin(model_, particles));
  make_world({skin, search_reach(model_, particles, skin), num_particles_, !particles.bonds.empty(),
              barchan::force_grain(model_, particles)});
  for (const ParticleData& p : particles.particles)
    world_.quick_travel = std::min(world_.quick_travel, 0.5 * p.radius);
  make_strip();
  strip_->seed(particles);
  make_loop();
  schedule_->begin(0, top_speed());
  if (communicator_.is_root()) {
    for (std::string& warning : precision_warnings(model_, particles))
      note(std::move(warning), true);
  }
  const std::string coarse = coarse_grain_warning(world_.grain, model_, particles);
  if (!coarse.empty() && communicator_.is_root()) note(coarse, true);
}

template <int Dim>
void Simulation::EngineOf<Dim>::make_world(const WorldScale& scale) {
  scale_ = scale;
  set_up(world_, model_, scale, barchan::vector_width(options_.vector));
  if (options_.search) world_.search = *options_.search;
  for (const WallSpec& spec : model_.walls) walls_at_rebuild_.push_back(spec.point);
}

template <int Dim>
void Simulation::EngineOf<Dim>::make_loop() {
  choice_ = settle_exchange(*strip_, options_, communicator_);
  strip_->restart_waits();
  graph_ = std::make_unique<StepGraph<Dim>>(*strip_, options_);
  schedule_ = std::make_unique<RebuildSchedule>(communicator_, world_.skin, world_.dt,
                                                model_.gravity.norm(), kEventSteps);
  tuned_skin_ = world_.skin;
  if (communicator_.is_root() && options_.tune_skin && !model_.search.skin)
    tuner_.emplace(world_.skin);
  plates_ = std::make_unique<Plates>(communicator_, world_.wall_specs, world_.dt);
  if (options_.trace) make_trace();
  watch_growth();
}

template <int Dim>
void Simulation::EngineOf<Dim>::make_trace() {
  trace_ = std::make_unique<Trace>(communicator_, strip_->neighbours(), options_.threads,
                                   options_.trace_events);
  graph_->set_trace(trace_.get());
  strip_->set_trace(trace_.get());
}

template <int Dim>
void Simulation::EngineOf<Dim>::make_strip() {
  if (options_.threads <= 0) options_.threads = default_threads(communicator_);
  const int fit = max_strips(world_.grid.num_slabs(), kMinSlabs);
  check_ranks(communicator_.size(), model_, world_.grid.num_slabs());
  const int lanes = std::clamp(options_.threads, 1, std::max(1, fit / communicator_.size()));
  auto exchange = first_exchange(
      options_, communicator_,
      strip_neighbours(communicator_.rank(), communicator_.size(), world_.grid.is_periodic(0)));
  const bool returns = options_.exchange == "return";
  strip_ = std::make_unique<Strip<Dim>>(world_, communicator_, std::move(exchange), lanes, returns);
}

template class Simulation::EngineOf<2>;
template class Simulation::EngineOf<3>;

}  // namespace barchan
