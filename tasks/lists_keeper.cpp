#include <barchan/tasks/lists_keeper.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <barchan/core/base/clock.hpp>
#include <barchan/core/brick/measure.hpp>

namespace barchan {
namespace {

constexpr double kChunkSeconds = 100e-6;
constexpr std::int64_t kLeastChunk = 2048, kMostChunk = 1 << 20;  // pairs

/// What is not a number is more than any, and stays.
void take_larger(double& most, double value) {
  if (!std::isnan(most) && !(value <= most)) most = value;
}

}  // namespace

template <int Dim>
ListsKeeper<Dim>::ListsKeeper(RunParts<Dim>& run, StepGraph<Dim>& graph, RebuildSchedule& schedule,
                              const RunOptions& options)
    : run_(run),
      graph_(graph),
      schedule_(schedule),
      hooks_(options.hooks),
      tuned_skin_(run.world.skin) {
  if (run.communicator.is_root() && options.tune_skin && !run.model.search.skin)
    tuner_.emplace(run.world.skin);
  note_walls();
}

template <int Dim>
void ListsKeeper<Dim>::note_walls() {
  walls_at_renewal_.clear();
  for (const WallState& wall : run_.world.walls) walls_at_renewal_.push_back(wall.point);
}

template <int Dim>
Travel ListsKeeper<Dim>::travel() const {
  Travel most;
  for (const Lane<Dim>& lane : run_.strip.lanes()) {
    const Travel t = barchan::travel(lane.brick);
    take_larger(most.distance2, t.distance2);
    take_larger(most.speed2, t.speed2);
  }
  for (std::size_t w = 0; w < walls_at_renewal_.size(); ++w) {
    const WallState& wall = run_.world.walls[w];
    take_larger(most.speed2, wall.velocity.squaredNorm());
    if (wall.is_active)
      take_larger(most.distance2, (wall.point - walls_at_renewal_[w]).squaredNorm());
  }
  return most;
}

template <int Dim>
double ListsKeeper<Dim>::top_speed() const {
  double speed = std::sqrt(travel().speed2);
  run_.communicator.allreduce_max(std::span(&speed, 1));
  return speed;
}

template <int Dim>
double ListsKeeper<Dim>::wall_outrun() const {
  double most = 0.0;
  for (std::size_t w = 0; w < walls_at_renewal_.size(); ++w) {
    const WallState& wall = run_.world.walls[w];
    if (!wall.is_active) continue;
    // As the last step found it, before it moved on.
    const Vec3 at = wall.point - run_.world.last_dt * wall.velocity;
    most = std::max(most, (at - walls_at_renewal_[w]).squaredNorm());
  }
  return outrun_share(most, run_.world.skin);
}

template <int Dim>
double ListsKeeper<Dim>::wished_skin(std::int64_t step) {
  if (!tuner_) return 0.0;
  const StepTimes times = graph_.times();
  return tuner_->wish(step, times.chunks + times.bands + seconds_);
}

template <int Dim>
void ListsKeeper<Dim>::take_skin(double skin) {
  if (skin > 0.0) tuned_skin_ = skin;
  is_demanded_ = is_demanded_ || next_skin() != run_.world.skin;
}

/// Where particles may soon pass each other in a step, lists have all that might.
template <int Dim>
double ListsKeeper<Dim>::next_skin() const {
  const World<Dim>& world = run_.world;
  return 2.0 * schedule_.speed() * world.dt > world.quick_travel ? run_.scale.skin : tuned_skin_;
}

/// Chunks of about kChunkSeconds, by what the pairs have cost since the last renewal.
template <int Dim>
void ListsKeeper<Dim>::size_chunks(std::int64_t step) {
  std::int64_t pairs = 0;
  for (const Lane<Dim>& lane : run_.strip.lanes()) pairs += lane.brick.num_pairs();
  const double seconds = graph_.times().chunks - chunk_seconds_;
  const double worked =
      static_cast<double>(pairs * (step - chunks_sized_at_)) / run_.strip.num_lanes();
  chunk_seconds_ += seconds;
  chunks_sized_at_ = step;
  if (worked <= 0.0 || seconds <= 0.0) return;
  run_.rebuild.chunk_pairs = std::clamp(static_cast<std::int64_t>(kChunkSeconds * worked / seconds),
                                        kLeastChunk, kMostChunk);
}

template <int Dim>
void ListsKeeper<Dim>::note_work(std::int64_t step) {
  for (int l = 0; l < run_.strip.num_lanes(); ++l) {
    const std::int64_t particles = run_.strip.lane(l).brick.store.num_owned;
    run_.rebuild.work().note(l, graph_.worked(l), particles, step);
  }
}

template <int Dim>
void ListsKeeper<Dim>::renew(std::int64_t step) {
  size_chunks(step);
  const std::int64_t begin = now_ns();
  const double outrun = wall_outrun();
  run_.world.skin = next_skin();
  schedule_.set_skin(run_.world.skin);
  note_work(step);
  if (step >= hooks_.loss.step && run_.communicator.rank() + 1 == run_.communicator.size())
    run_.strip.lane(0).rebuild.carry().lose(std::exchange(hooks_.loss.what, Loss::Nothing));
  run_.rebuild.rebuild(
      [this](const std::function<void(int)>& body) { graph_.for_each_lane(body); });
  double& told = run_.strip.lane(0).brick.outrun;
  told = std::max(told, outrun);
  note_walls();
  schedule_.rebuilt(step);
  is_demanded_ = false;
  const std::int64_t end = now_ns();
  seconds_ += to_seconds(end - begin);
  if (run_.strip.trace() != nullptr)
    run_.strip.trace()->slice(Trace::Slice::Rebuild, 0, begin, end);
}

template class ListsKeeper<2>;
template class ListsKeeper<3>;

}  // namespace barchan
