#include <barchan/tasks/engine.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/core/base/clock.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/tasks/exchange_setup.hpp>
#include <barchan/tasks/forecast.hpp>
#include <barchan/tasks/parts_checkpoint.hpp>
#include <barchan/tasks/stop_request.hpp>
#include <barchan/tasks/wrong_step.hpp>

namespace barchan {

template <int Dim>
Simulation::EngineOf<Dim>::EngineOf(const Model& model, Communicator communicator,
                                    const RunOptions& options, const WorldScale& scale)
    : Engine(model, std::move(communicator), options),
      parts_(model_, communicator_, options_, scale),
      graph_(parts_.strip, options_),
      schedule_(communicator_, parts_.world.skin, parts_.world.dt, model_.gravity.norm(),
                kEventSteps, lag_of(parts_)),
      lists_(parts_, graph_, schedule_, options_),
      watch_(parts_, graph_, population_, notes_),
      plates_(communicator_, parts_.world.wall_specs, parts_.world.dt) {}

template <int Dim>
Simulation::EngineOf<Dim>::EngineOf(const Model& model, const ParticleSet& particles,
                                    Communicator communicator, const RunOptions& options)
    : EngineOf(model, std::move(communicator), options, scale_of(model, particles)) {
  population_.size = static_cast<std::int64_t>(particles.particles.size());
  for (const ParticleData& p : particles.particles)
    parts_.world.quick_travel = std::min(parts_.world.quick_travel, 0.5 * p.radius);
  parts_.rebuild.seed(particles);
  begin_loop();
  schedule_.begin(0, lists_.top_speed());
  if (!communicator_.is_root()) return;
  for (const std::string& warning : precision_warnings(model_, particles))
    notes_.add(0, warning, true);
  const std::string coarse = coarse_grain_warning(parts_.world.grain, model_, particles);
  if (!coarse.empty()) notes_.add(0, coarse, true);
}

template <int Dim>
Simulation::EngineOf<Dim>::EngineOf(const Model& model, const OpenCheckpoint& checkpoint,
                                    Communicator communicator, const RunOptions& options)
    : EngineOf(model, std::move(communicator), options, scale_of(checkpoint.state, model)) {
  const CheckpointState& s = checkpoint.state;
  restored_from_ = checkpoint.path;
  population_.size = restore_parts(parts_, checkpoint);
  population_.left = s.left;
  lists_.note_walls();
  begin_loop();
  step_ = s.step;
  stages_.restore(s);
  (void)fields_.restore(s.fields);  // decode_state has seen that they are fields
  if (s.last_dt > 0.0) {
    since_ = s.since;
    parts_.world.last_dt = s.last_dt;
  }
  schedule_.restore(step_, lists_.top_speed(), s.look,
                    communicator_.is_root() ? population_.size : 0);
}

template <int Dim>
void Simulation::EngineOf<Dim>::begin_loop() {
  choice_ = settle_exchange(parts_.strip, options_, communicator_);
  parts_.rebuild.restart_waits();
  growth_.look(parts_, step_, notes_);
  if (!options_.trace) return;
  trace_ = std::make_unique<Trace>(communicator_, parts_.strip.neighbours(), options_.threads,
                                   options_.trace_events);
  if (options_.trace_steps) trace_->keep(options_.trace_steps->first, options_.trace_steps->second);
  graph_.set_trace(trace_.get());
  parts_.strip.set_trace(trace_.get());
}

/// Some exchanges cannot be taken down while a message is on its way.
template <int Dim>
Simulation::EngineOf<Dim>::~EngineOf() {
  if (is_in_step_ || std::uncaught_exceptions() > 0) return;
  if (!is_mpi_initialized()) return;  // nothing of MPI is left to be taken down
  try {
    (void)parts_.strip.discard_halo();
  } catch (const std::exception&) {  // the others are gone
  }
}

template <int Dim>
std::int64_t Simulation::EngineOf<Dim>::run(std::int64_t num_steps) {
  begin_account();
  const std::int64_t begin = now_ns();
  std::int64_t done = 0;
  if (num_steps > 0) tell_shadows_forces();
  stopped_ = stopped_ && num_steps == 0;
  try {
    while (done < num_steps && !stopped_ && !last_stage_ends()) {
      if (events_.is_visit_due(step_)) {
        visit_step();
        tell_shadows_forces();
      }
      done += go_on(events_.steps_before_next(step_, num_steps - done));
      if (events_.progress.is_due(step_)) tell_progress();
      if (events_.is_news_due(step_)) tell_news();
    }
    tell_news();
  } catch (const AgreedError&) {
    is_in_step_ = false;  // thrown before the step did anything
    failure_ = std::current_exception();
    throw;
  } catch (...) {
    failure_ = std::current_exception();
    throw;
  }
  loop_.loop += seconds_since(begin);
  loop_.steps += done;
  return done;
}

/// A step, or several where nothing has to be done between them. @return how many
template <int Dim>
std::int64_t Simulation::EngineOf<Dim>::go_on(std::int64_t most) {
  is_in_step_ = true;
  prepare_step();
  StepFrame frame;
  frame.step = step_;
  frame.last_dt = step_ == 0 ? 0.0 : parts_.world.last_dt;
  frame.kick = 0.5 * frame.last_dt + 0.5 * parts_.world.dt;
  for (int c = 0; c < 3; ++c) frame.gravity[c] = model_.gravity[c];
  frame.local_damping = stages_.spec().local_damping;
  const int steps = steps_in_a_go(most);
  plates_.set_steps(parts_.world.last_dt, parts_.world.dt);
  const bool drives_plates = plates_.are_driven(walls());
  if (drives_plates) {
    // Contacts with plates are few, so one thread does all lanes.
    const std::span<WallSums> sums = plates_.start_sums();
    for (Lane<Dim>& lane : parts_.strip.lanes()) lane.step.press_plates(frame, sums);
    plates_.begin(sums);
  }
  graph_.run(frame, steps);
  if (const int nth = wrong_step(parts_.strip, graph_); nth > 0) {
    step_ += nth - 1;
    report_wrong_step(parts_, graph_, nth, step_);
  }
  if (drives_plates) {
    // All ranks know the work of a plate; the first one counts it.
    plates_.kick(parts_.world.walls, stages_.begins_at(step_) ? stages_.current() : -1,
                 communicator_.is_root() ? std::span(parts_.strip.lane(0).brick.wall_sums)
                                         : std::span<WallSums>());
  }
  plates_.move(parts_.world.walls);
  step_ += steps;
  parts_.world.last_dt = parts_.world.dt;
  is_in_step_ = false;
  return steps;
}

/// All that comes between two steps.
template <int Dim>
void Simulation::EngineOf<Dim>::prepare_step() {
  if (trace_) trace_->begin_step(step_);
  parts_.strip.step = step_;
  if (keeper_) keeper_->poll();
  if (keeper_ && (keeper_->is_demanded() || keeper_->is_due(step_))) save_checkpoint();
  if (!stages_.is_last() && stage_is_over()) {
    stages_.enter_next(step_);
    if (show_walls(parts_, stages_, step_)) lists_.demand();  // walls come into the lists
  }
  update_lists();
  watch_.judge_plates(step_);
  if (schedule_.is_check_due(step_)) begin_check();
  schedule_.poll();
}

template <int Dim>
bool Simulation::EngineOf<Dim>::stage_is_over() {
  if (step_ == 0 || !stages_.may_end(step_)) return false;
  if (stages_.time_is_over(step_)) return true;
  return taped_verdict(communicator_, [&] {
    const Measures m = measure();
    return m.kinetic.value() < stages_.spec().kinetic_ratio * m.elastic.value();
  });
}

/// The run ends with its last stage, between two steps; a restart from there comes to the same
/// verdict.
template <int Dim>
bool Simulation::EngineOf<Dim>::last_stage_ends() {
  if (is_over_ || !stages_.is_last() || !stage_is_over()) return is_over_;
  is_over_ = true;
  if (communicator_.is_root())
    notes_.add(step_, fmt::format("the last stage, '{}', is over, and the run with it",
                                  stages_.spec().name));
  return true;
}

/// Takes the last check's answer when its time has come, and makes lists anew where somebody asks
/// for it.
template <int Dim>
void Simulation::EngineOf<Dim>::update_lists() {
  const bool have_ended = schedule_.must_rebuild(step_);
  if (schedule_.take_stop_agreed()) {
    stopped_ = true;
    forget_stop_request();
  }
  if (schedule_.take_save_agreed()) {
    if (keeper_) keeper_->demand();
    forget_checkpoint_request();
  }
  if (const auto answer = schedule_.take_answer()) {
    watch_.judge(step_, *answer);
    lists_.take_skin(answer->skin);
  }
  if (watch_.remove_outside(step_)) lists_.demand();
  if (!have_ended && !lists_.are_demanded(step_)) return;
  renew_lists();
}

template <int Dim>
void Simulation::EngineOf<Dim>::renew_lists() {
  if (!is_in_step_) parts_.strip.forget_shadows();  // a caller changed the state
  lists_.renew(step_);
  generation_.advance();
  growth_.look(parts_, step_, notes_);
}

template <int Dim>
void Simulation::EngineOf<Dim>::begin_check() {
  const Travel travel = lists_.travel();
  CheckNumbers mine;
  mine.distance = std::sqrt(travel.distance2);
  mine.speed = std::sqrt(travel.speed2);
  mine.skin = lists_.wished_skin(step_);
  if (schedule_.is_look(step_)) watch_.look(step_, mine);
  watch_.count(mine);
  const bool wants_to_save =
      keeper_ != nullptr && (checkpoint_is_requested() || keeper_->is_overdue());
  schedule_.begin_check(mine, {stop_is_requested(), wants_to_save});
}

/// Lanes need not wait for each other between steps at which nobody looks at all of them. With
/// neighbours ranks do not anyway. A check's answer that only says when the next is due is taken at
/// the check: what all lanes do until then is known.
template <int Dim>
int Simulation::EngineOf<Dim>::steps_in_a_go(std::int64_t most) {
  if (parts_.strip.exchange() != nullptr || parts_.strip.num_lanes() == 1 || step_ == 0) return 1;
  if (parts_.world.last_dt != parts_.world.dt) return 1;  // the kick of the first one alone differs
  if (!stages_.is_last() || !plates_.stand_still(walls())) return 1;
  const auto steps_until = [&](std::int64_t end) {
    std::int64_t steps = 1;
    end = std::min(end, step_ + most);
    while (step_ + steps < end && !(keeper_ && keeper_->is_due(step_ + steps)) &&
           !stages_.may_end(step_ + steps))
      ++steps;
    return static_cast<int>(steps);
  };
  if (schedule_.is_check_due(step_)) {
    const auto foreseen = schedule_.foresee();
    const int steps =
        foreseen && watch_.is_harmless(foreseen->answer) ? steps_until(foreseen->next_check) : 0;
    if (steps > RebuildSchedule::kLag) {
      (void)schedule_.must_rebuild(step_ + RebuildSchedule::kLag);
      (void)schedule_.take_answer();
      return steps;
    }
  }
  return steps_until(schedule_.next_part(step_));
}

template <int Dim>
Measures Simulation::EngineOf<Dim>::measure() {
  begin_account();
  const Measures m = barchan::measure(parts_);
  watch_.see_overlap(m.max_overlap_share);
  return m;
}

/// At the first step that there is one for, of a restart from a run without one, too.
template <int Dim>
void Simulation::EngineOf<Dim>::begin_account() {
  if (!parts_.world.accounts || std::exchange(has_account_, true)) return;
  const Measures m = barchan::measure(parts_);
  if (m.works[EnergyWorks::Begun].value() != 0.0) return;
  if (!communicator_.is_root()) return;
  ExactSum walls;
  for (const WallState& wall : parts_.world.walls) walls.add(wall.work);
  EnergyWorks& works = parts_.strip.lane(0).brick.works;
  works.begin(m.kinetic, m.elastic, m.bonds_elastic, walls);
  works.begin_springs(m.sliding_elastic, m.rolling_elastic);
  if (step_ > 0) notes_.add(step_, "the account of energy begins here");
}

template <int Dim>
Timings Simulation::EngineOf<Dim>::timings() const {
  LoopSeconds loop = loop_;
  loop.rebuilds = lists_.seconds();
  loop.reductions = schedule_.wait_seconds() + plates_.wait_seconds();
  Timings t = timings_of(parts_, graph_.times(), loop);
  for (int l = 0; l < parts_.strip.num_lanes(); ++l)
    t.worked.push_back(to_seconds(graph_.worked(l)));
  return t;
}

template <int Dim>
CheckpointState Simulation::EngineOf<Dim>::state() {
  CheckpointState s;
  s.step = step_;
  s.num_particles = population_.size;
  s.left = population_.left;
  s.look = schedule_.pending_look(step_);
  s.fields = fields_.saved();
  if (since_.step > 0) {
    s.since = since_;
    s.last_dt = parts_.world.last_dt;
  }
  stages_.save(s);
  save_parts(parts_, s);
  return s;
}

template <int Dim>
void Simulation::EngineOf<Dim>::save_checkpoint() {
  const std::int64_t begin = now_ns();
  parts_.strip.complete_halo();  // whether pairs across cuts touch
  CheckpointCopy& copy = keeper_->begin();
  copy.step = step_;
  copy.time = time();
  copy_lanes(parts_, graph_, lists_.wall_outrun(), copy);
  copy.state.clear();
  if (communicator_.is_root()) copy.state = encode(state());
  keeper_->start();
  if (is_in_step_) loop_.checkpoints += seconds_since(begin);
}

template class Simulation::EngineOf<2>;
template class Simulation::EngineOf<3>;

}  // namespace barchan
