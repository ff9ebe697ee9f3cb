#include <barchan/tasks/engine.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <barchan/comm/base/clock.hpp>
#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/check_walls.hpp>
#include <barchan/tasks/stop_request.hpp>

namespace barchan {
namespace {

constexpr double kChunkSeconds = 100e-6;
constexpr std::int64_t kLeastChunk = 2048, kMostChunk = 1 << 20;  // pairs
constexpr std::int64_t kStageCheck = 100;  // steps between looks at the kinetic ratio

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

/// Some exchanges cannot be taken down while a message is on its way.
template <int Dim>
Simulation::EngineOf<Dim>::~EngineOf() {
  if (is_in_step_ || strip_ == nullptr || std::uncaught_exceptions() > 0) return;
  if (!is_mpi_initialized()) return;  // nothing of MPI is left to be taken down
  try {
    strip_->complete_halo();
  } catch (const std::exception&) {  // the others are gone
  }
}

template <int Dim>
std::int64_t Simulation::EngineOf<Dim>::run(std::int64_t num_steps) {
  const double begin = now();
  std::int64_t done = 0;
  stopped_ = stopped_ && num_steps == 0;
  try {
    while (done < num_steps && !stopped_ && !last_stage_ends()) done += go_on(num_steps - done);
  } catch (const AgreedError&) {
    is_in_step_ = false;  // thrown before the step did anything
    failure_ = std::current_exception();
    throw;
  } catch (...) {
    failure_ = std::current_exception();
    throw;
  }
  loop_seconds_ += now() - begin;
  loop_steps_ += done;
  return done;
}

/// A step, or several where nothing has to be done between them. @return how many
template <int Dim>
std::int64_t Simulation::EngineOf<Dim>::go_on(std::int64_t most) {
  is_in_step_ = true;
  if (trace_) trace_->begin_step(step_);
  strip_->step = step_;
  if (keeper_) keep_checkpoints();
  update_stage();
  update_lists();
  watch_plates();
  if (schedule_->is_check_due(step_))
    schedule_->begin_check(check_numbers(), {stop_is_requested(), wants_checkpoint()});
  schedule_->poll();

  StepFrame frame;
  frame.step = step_;
  frame.kick = step_ == 0 ? 0.5 * world_.dt : world_.dt;
  for (int c = 0; c < 3; ++c) frame.gravity[c] = model_.gravity[c];
  frame.local_damping = model_.stages[static_cast<std::size_t>(stage_)].local_damping;
  const int steps = steps_in_a_go(most);
  const bool drives_plates = plates_->are_driven(world_.walls);
  if (drives_plates) press_plates(frame);
  graph_->run(frame, steps);
  stop_if_wrong();

  if (drives_plates) kick_plates();
  plates_->move(world_.walls);
  step_ += steps;
  is_in_step_ = false;
  return steps;
}

/// Lanes need not wait for each other between steps at which nobody looks at all of them. With
/// neighbours ranks do not anyway. A check's answer that only says when the next is due is taken at
/// the check: what all lanes do until then is known.
template <int Dim>
int Simulation::EngineOf<Dim>::steps_in_a_go(std::int64_t most) {
  if (strip_->exchange() != nullptr || strip_->num_lanes() == 1 || step_ == 0) return 1;
  const bool walls_stand = std::all_of(
      world_.walls.begin(), world_.walls.end(),
      [](const WallState& wall) { return !wall.is_active || wall.velocity == Vec3::Zero(); });
  if (!is_last_stage() || !walls_stand || plates_->are_driven(world_.walls)) return 1;
  const auto steps_until = [&](std::int64_t end) {
    std::int64_t steps = 1;
    end = std::min(end, step_ + most);
    while (step_ + steps < end && !(keeper_ && keeper_->is_due(step_ + steps)) &&
           !stage_may_end(step_ + steps))
      ++steps;
    return static_cast<int>(steps);
  };
  if (schedule_->is_check_due(step_)) {
    const auto foreseen = schedule_->foresee();
    const int steps =
        foreseen && is_harmless(foreseen->answer) ? steps_until(foreseen->next_check) : 0;
    if (steps > RebuildSchedule::kLag) {
      (void)schedule_->must_rebuild(step_ + RebuildSchedule::kLag);
      (void)schedule_->take_answer();
      return steps;
    }
  }
  return steps_until(schedule_->next_part(step_));
}

/// The earliest step in which a lane went wrong, and in that the lowest ids of two that passed each
/// other, or of a fast particle, or the lane with the particle that bore most.
template <int Dim>
void Simulation::EngineOf<Dim>::stop_if_wrong() {
  int steps = std::numeric_limits<int>::max();
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    if (strip_->lane(l).must_stop()) steps = std::min(steps, graph_->steps_done(l));
  }
  if (steps == std::numeric_limits<int>::max()) return;
  step_ += steps - 1;
  int fast = -1, pressed = -1;
  Passage passage;
  const auto id_in = [this](int l) {
    const Lane<Dim>& lane = strip_->lane(l);
    return lane.store().id[static_cast<std::size_t>(lane.first_fast_row())];
  };
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    const Lane<Dim>& lane = strip_->lane(l);
    if (!lane.must_stop() || graph_->steps_done(l) != steps) continue;
    if (pressed < 0 || lane.overload() > strip_->lane(pressed).overload()) pressed = l;
    passage.add(lane.passage());
    if (lane.is_fast() && (fast < 0 || id_in(l) < id_in(fast))) fast = l;
  }
  if (passage.exists()) report_passage(passage);
  if (fast >= 0) report_fast(fast);
  report_overload(pressed);
}

/// Chunks of about kChunkSeconds, by what the pairs have cost since the last rebuild. No bit
/// depends on it.
template <int Dim>
void Simulation::EngineOf<Dim>::size_chunks() {
  std::int64_t pairs = 0;
  for (int l = 0; l < strip_->num_lanes(); ++l) pairs += strip_->lane(l).num_pairs();
  const double seconds = graph_->times().chunks - chunk_seconds_;
  const auto worked = static_cast<double>(pairs / strip_->num_lanes() * (step_ - chunks_sized_at_));
  chunk_seconds_ += seconds;
  chunks_sized_at_ = step_;
  if (worked <= 0.0 || seconds <= 0.0) return;
  strip_->chunk_pairs = std::clamp(static_cast<std::int64_t>(kChunkSeconds * worked / seconds),
                                   kLeastChunk, kMostChunk);
}

template <int Dim>
void Simulation::EngineOf<Dim>::update_lists() {
  const bool travelled = schedule_->must_rebuild(step_);
  if (schedule_->take_stop_agreed()) {
    stopped_ = true;
    forget_stop_request();
  }
  if (schedule_->take_save_agreed()) {
    must_save_ = true;
    forget_checkpoint_request();
  }
  if (const auto answer = schedule_->take_answer()) {
    judge(*answer);
    if (answer->skin > 0.0) tuned_skin_ = answer->skin;
    must_rebuild_ = must_rebuild_ || next_skin() != world_.skin;
  }
  if (must_remove_) remove_outside();
  const bool is_test = options_.rebuild_every > 0 && step_ % options_.rebuild_every == 0;
  if (!travelled && !must_rebuild_ && !is_test) return;
  size_chunks();
  const double begin = now();
  const double walls_outran = outrun_share(wall_distance2(), world_.skin);
  world_.skin = next_skin();
  schedule_->set_skin(world_.skin);
  if (step_ >= options_.loss.step && communicator_.rank() + 1 == communicator_.size())
    strip_->lane(0).lose(std::exchange(options_.loss.what, Loss::Nothing));
  strip_->rebuild([this](const std::function<void(int)>& body) { graph_->for_each_lane(body); });
  strip_->lane(0).note_outrun(walls_outran);
  for (std::size_t w = 0; w < world_.walls.size(); ++w)
    walls_at_rebuild_[w] = world_.walls[w].point;
  watch_growth();
  schedule_->rebuilt(step_);
  must_rebuild_ = false;
  rebuild_seconds_ += now() - begin;
  if (trace_)
    trace_->slice(Trace::Slice::Rebuild, 0, static_cast<std::int64_t>(1e9 * begin), now_ns());
}

/// Where particles may soon pass each other in a step, lists have all that might.
template <int Dim>
double Simulation::EngineOf<Dim>::next_skin() const {
  return 2.0 * schedule_->speed() * world_.dt > world_.quick_travel ? scale_.skin : tuned_skin_;
}

template <int Dim>
bool Simulation::EngineOf<Dim>::is_last_stage() const {
  return static_cast<std::size_t>(stage_) + 1 == model_.stages.size();
}

template <int Dim>
void Simulation::EngineOf<Dim>::update_stage() {
  if (step_ > 0 && !is_last_stage() && stage_is_over()) enter_stage(stage_ + 1);
}

/// The run ends with its last stage, between two steps; a restart from there comes to the same
/// verdict.
template <int Dim>
bool Simulation::EngineOf<Dim>::last_stage_ends() {
  if (is_over_ || step_ == 0 || !is_last_stage() || !stage_is_over()) return is_over_;
  is_over_ = true;
  if (communicator_.is_root())
    note(fmt::format("the last stage, '{}', is over, and the run with it",
                     model_.stages.back().name));
  return true;
}

template <int Dim>
bool Simulation::EngineOf<Dim>::stage_time_is_over(std::int64_t step) const {
  const Stage& stage = model_.stages[static_cast<std::size_t>(stage_)];
  return static_cast<double>(step - stage_begin_) * world_.dt >= stage.max_time - 0.5 * world_.dt;
}

/// Whether somebody must look, before that step, whether the stage is over.
template <int Dim>
bool Simulation::EngineOf<Dim>::stage_may_end(std::int64_t step) const {
  if (stage_time_is_over(step)) return true;
  const std::int64_t steps = step - stage_begin_;
  return model_.stages[static_cast<std::size_t>(stage_)].kinetic_ratio > 0.0 && steps > 0 &&
         steps % kStageCheck == 0;
}

template <int Dim>
bool Simulation::EngineOf<Dim>::stage_is_over() {
  if (!stage_may_end(step_)) return false;
  if (stage_time_is_over(step_)) return true;
  const Stage& stage = model_.stages[static_cast<std::size_t>(stage_)];
  return taped_verdict(communicator_, [&] {
    const Measures m = measure();
    return m.kinetic.value() < stage.kinetic_ratio * m.elastic.value();
  });
}

template <int Dim>
void Simulation::EngineOf<Dim>::enter_stage(int stage) {
  stage_ = stage;
  stage_begin_ = step_;
  for (std::size_t w = 0; w < world_.walls.size(); ++w) {
    const bool active = world_.wall_specs[w].from_stage <= stage;
    if (active == world_.walls[w].is_active) continue;
    must_rebuild_ = true;  // walls come into the lists
    world_.walls[w].is_active = active;
    refuse_intruders(w);
  }
}

/// Collective. A wall that appears where a particle is would throw it out.
template <int Dim>
void Simulation::EngineOf<Dim>::refuse_intruders(std::size_t wall) {
  std::int64_t first = 0, count = 0;
  std::string what;
  for_each_owned([&](const OwnedParticle& p) {
    ParticleData here;
    here.id = p.id;
    here.radius = p.radius;
    here.position = p.position;
    here.fixed = std::isinf(p.mass);
    const WallFoot foot =
        world_.wall_shapes[wall].foot(world_.walls[wall].point, p.position.data());
    const auto found = intrusion(world_.wall_specs[wall], foot, here, Dim);
    if (!found) return;
    ++count;
    if (first != 0 && first < p.id) return;
    first = p.id;
    what = *found;
  });
  communicator_.allreduce_sum(std::span(&count, 1));
  if (count == 0) return;
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  what = from_rank_with_most(first == 0 ? kNone : -static_cast<double>(first), what);
  throw AgreedError(fmt::format(
      "at step {} wall '{}' appears with stage '{}' where particles are: {}{}; let it appear "
      "elsewhere or later, or take particles away from there",
      step_, model_.walls[wall].name, model_.stages[static_cast<std::size_t>(stage_)].name, what,
      count == 1 ? "" : fmt::format(", and {} more", count - 1)));
}

/// What particles press loaded plates with, on its way to all ranks while the step is computed.
/// Contacts with plates are few, so one thread does all lanes.
template <int Dim>
void Simulation::EngineOf<Dim>::press_plates(const StepFrame& frame) {
  plate_sums_.assign(world_.walls.size(), WallSums());
  for (int l = 0; l < strip_->num_lanes(); ++l) strip_->lane(l).press_plates(frame, plate_sums_);
  plates_->begin(plate_sums_);
}

/// All ranks know the work of a plate; the first one counts it.
template <int Dim>
void Simulation::EngineOf<Dim>::kick_plates() {
  const int appears_in = step_ == stage_begin_ ? stage_ : -1;
  plate_sums_.assign(world_.walls.size(), WallSums());
  plates_->kick(world_.walls, appears_in,
                communicator_.is_root() ? strip_->lane(0).wall_sums() : plate_sums_);
}

template class Simulation::EngineOf<2>;
template class Simulation::EngineOf<3>;

}  // namespace barchan
