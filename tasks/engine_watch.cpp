#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/base/error.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/engine.hpp>

// What can go wrong in a run: noticed with the checks of the rebuild schedule, at no message more,
// and told with the particles that it is about (engine_report.cpp). Only a run that ends or a
// particle that goes costs messages of its own.

namespace barchan {
namespace {

constexpr std::int64_t kOverlapEvery = 1000;  // steps between looks at overlaps, at least

}  // namespace

template <int Dim>
double Simulation::EngineOf<Dim>::wall_distance2() const {
  double most = 0.0;
  for (std::size_t w = 0; w < world_.walls.size(); ++w) {
    const WallState& wall = world_.walls[w];
    if (!wall.is_active) continue;
    // As the last step found it, before it moved on.
    const Vec3 at = wall.point - world_.dt * wall.velocity;
    most = std::max(most, (at - walls_at_rebuild_[w]).squaredNorm());
  }
  return most;
}

template <int Dim>
Travel Simulation::EngineOf<Dim>::travel() const {
  Travel most;
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    const Travel t = strip_->lane(l).travel();
    if (!(t.distance2 <= most.distance2)) most.distance2 = t.distance2;
    if (!(t.speed2 <= most.speed2)) most.speed2 = t.speed2;
  }
  for (std::size_t w = 0; w < world_.walls.size(); ++w) {
    const WallState& wall = world_.walls[w];
    if (!(wall.velocity.squaredNorm() <= most.speed2)) most.speed2 = wall.velocity.squaredNorm();
    if (!wall.is_active) continue;
    const double distance2 = (wall.point - walls_at_rebuild_[w]).squaredNorm();
    if (!(distance2 <= most.distance2)) most.distance2 = distance2;
  }
  return most;
}

/// Of all ranks. Collective.
template <int Dim>
double Simulation::EngineOf<Dim>::top_speed() const {
  double speed = std::sqrt(travel().speed2);
  communicator_.allreduce_max(std::span(&speed, 1));
  return speed;
}

template <int Dim>
CheckNumbers Simulation::EngineOf<Dim>::check_numbers() {
  const Travel t = travel();
  CheckNumbers mine;
  mine.distance = std::sqrt(t.distance2);
  mine.speed = std::sqrt(t.speed2);
  mine.particles = strip_->num_owned();
  if (tuner_) {
    const StepTimes times = graph_->times();
    mine.skin = tuner_->wish(step_, times.chunks + times.bands + rebuild_seconds_);
  }
  if (schedule_->is_look(step_)) {
    watch_overlap();
    for (int l = 0; l < strip_->num_lanes(); ++l)
      mine.outside = std::max(mine.outside, strip_->lane(l).last_outside());
    mine.overlap = std::exchange(overlap_, 0.0);
  }
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    const LinkCounts& lane = strip_->lane(l).imbalance();
    mine.imbalance.contacts += lane.contacts;
    mine.imbalance.wall_contacts += lane.wall_contacts;
    mine.imbalance.bonds += lane.bonds;
  }
  return mine;
}

/// Whether there is nothing to judge. Alike on every rank.
template <int Dim>
bool Simulation::EngineOf<Dim>::is_harmless(const CheckNumbers& answer) const {
  const LinkCounts& links = answer.imbalance;
  return answer.distance <= 0.5 * world_.skin && std::isfinite(answer.speed) &&
         answer.outside == 0 && answer.overlap <= model_.limits.overlap_warning &&
         answer.overlap <= model_.limits.overlap_error && answer.particles == num_particles_ &&
         links.contacts == 0 && links.wall_contacts == 0 && links.bonds == 0;
}

/// Collective, as is all that follows. Every rank comes to the same verdict.
template <int Dim>
void Simulation::EngineOf<Dim>::judge(const CheckNumbers& answer) {
  must_remove_ = false;
  if (is_harmless(answer)) return;
  if (!std::isfinite(answer.distance) || !std::isfinite(answer.speed)) {
    throw AgreedError(
        fmt::format("at step {} the state is no longer finite: {}; start the run from step 0 with "
                    "a smaller time.step, more damping or less overlap",
                    step_, describe_fastest()));
  }
  judge_balance(answer);
  if (answer.outside > 0 && model_.domain.outside == OutsidePolicy::Error) {
    const auto left = departures();
    if (!left.empty()) report_departures(left);
  }
  if (answer.distance > 0.5 * world_.skin) report_outrun(answer);
  judge_overlap(answer.overlap);
  must_remove_ = answer.outside > 0;
}

template <int Dim>
void Simulation::EngineOf<Dim>::judge_balance(const CheckNumbers& answer) {
  std::vector<std::string> wrong;
  const auto compare = [&](std::int64_t difference, const char* one, const char* many) {
    if (difference == 0) return;
    const std::int64_t count = std::abs(difference);
    wrong.push_back(fmt::format("{} {} too {}", count, count == 1 ? one : many,
                                difference < 0 ? "few" : "many"));
  };
  compare(answer.particles - num_particles_, "particle", "particles");
  compare(answer.imbalance.contacts, "contact", "contacts");
  compare(answer.imbalance.wall_contacts, "contact with a wall", "contacts with walls");
  compare(answer.imbalance.bonds, "bond", "bonds");
  if (wrong.empty()) return;
  throw AgreedError(
      fmt::format("at step {} all ranks together have {} since lists were rebuilt: a fault of the "
                  "program or the machine; restart from the last checkpoint, and report this",
                  step_, fmt::join(wrong, ", ")));
}

template <int Dim>
std::vector<Departure> Simulation::EngineOf<Dim>::departures() {
  std::vector<Departure> mine;
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    const auto lane = strip_->lane(l).outside(step_);
    mine.insert(mine.end(), lane.begin(), lane.end());
  }
  std::string all;
  for (const auto& piece : communicator_.gather(std::as_bytes(std::span(mine))))
    all.append(reinterpret_cast<const char*>(piece.data()), piece.size());
  all = communicator_.bcast(std::move(all));
  std::vector<Departure> found(all.size() / sizeof(Departure));
  std::memcpy(found.data(), all.data(), found.size() * sizeof(Departure));
  std::sort(found.begin(), found.end(),
            [](const Departure& p, const Departure& q) { return p.id < q.id; });
  if (found.empty()) return found;
  agree(communicator_, [&] {
    if (communicator_.is_root() && tell_departures_) tell_departures_(found);
  });
  return found;
}

/// What is out of the domain now goes with the rebuild that follows.
template <int Dim>
void Simulation::EngineOf<Dim>::remove_outside() {
  must_remove_ = false;
  const std::vector<Departure> left = departures();
  if (left.empty()) return;  // it came back meanwhile
  std::vector<std::int64_t> ids;
  for (const Departure& d : left) ids.push_back(d.id);
  std::int64_t gone[3] = {};
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    const LinkCounts lane = strip_->lane(l).remove(ids);
    gone[0] += lane.contacts;
    gone[1] += lane.wall_contacts;
    gone[2] += lane.bonds;
  }
  communicator_.allreduce_sum(std::span<std::int64_t>(gone));
  const auto count = static_cast<std::int64_t>(left.size());
  num_particles_ -= count;
  left_.particles += count;
  left_.links.contacts += gone[0];
  left_.links.wall_contacts += gone[1];
  left_.links.bonds += gone[2];
  must_rebuild_ = true;
  if (communicator_.is_root()) note_departures(left, gone[0] + gone[1], gone[2]);
}

/// At a look, now and then.
template <int Dim>
void Simulation::EngineOf<Dim>::watch_overlap() {
  if (step_ / kOverlapEvery == overlap_watched_at_ / kOverlapEvery) return;
  overlap_watched_at_ = step_;
  strip_->complete_halo();
  std::vector<double> shares(static_cast<std::size_t>(strip_->num_lanes()), 0.0);
  graph_->for_each_lane(
      [&](int l) { shares[static_cast<std::size_t>(l)] = strip_->lane(l).worst_overlap().share; });
  for (const double share : shares) overlap_ = std::max(overlap_, share);
}

/// Plates have no thickness, and given velocities no limit.
template <int Dim>
void Simulation::EngineOf<Dim>::watch_plates() const {
  for (std::size_t w = 0; w < world_.walls.size(); ++w) {
    const WallState& wall = world_.walls[w];
    const double travel = world_.dt * wall.velocity.norm();
    if (!wall.is_active || model_.walls[w].kind != WallKind::Plate ||
        travel <= world_.most_travel(world_.skin))
      continue;
    throw AgreedError(fmt::format(
        "at step {} wall '{}' moves {:.3g} m in one step, more than half of the smallest radius "
        "({:.3g} m), so that it may pass particles unseen; {}",
        step_, model_.walls[w].name, travel, 2.0 * world_.quick_travel, remedy_for_travel(travel)));
  }
}

/// After a rebuild. Buffers grow by themselves; here it is only told, once they have grown by a
/// quarter.
template <int Dim>
void Simulation::EngineOf<Dim>::watch_growth() {
  std::size_t buffer = 0;
  const auto tell = [&](std::size_t size, bool is_mine, const auto& describe) {
    if (buffer == sizes_.size()) sizes_.push_back(size);  // at the start
    std::size_t& known = sizes_[buffer++];
    if (size < known + known / 4 + 1) return;
    if (is_mine) note(fmt::format("{} grow from {} to {}", describe(), known, size));
    known = size;
  };
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    Lane<Dim>& lane = strip_->lane(l);
    const auto named = [&](const char* what) {
      return [this, l, what] {
        return fmt::format("rank {}, lane {}: {}", communicator_.rank(), l, what);
      };
    };
    std::size_t candidates = 0;
    candidates += lane.pairs().i.capacity();
    for (const auto side : kSides) candidates += lane.band(side).across.i.capacity();
    tell(lane.store().id.capacity(), true, named("rows of particles and ghosts"));
    tell(candidates, true, named("candidate pairs"));
  }
  if (strip_->exchange() == nullptr) return;
  const ExchangeStats stats = strip_->exchange()->stats();  // equal on all ranks
  tell(stats.halo_capacity, communicator_.is_root(),
       [] { return "all ranks: bytes of a halo slot"; });
  tell(stats.bulk_capacity, communicator_.is_root(),
       [] { return "all ranks: bytes of a slot for migration"; });
}

template <int Dim>
void Simulation::EngineOf<Dim>::judge_overlap(double share) {
  const LimitSpec& limits = model_.limits;
  const bool is_error = share > limits.overlap_error;
  if (!is_error && (has_warned_ || share <= limits.overlap_warning)) return;
  const std::string what = fmt::format(
      "an overlap of {:.3g} of the smaller radius is beyond limits.{} = {:.3g}; {}; a higher "
      "limit lets the run continue, also from a checkpoint on; for stiffer contacts, start the run "
      "from step 0",
      share, is_error ? "overlap_error" : "overlap_warning",
      is_error ? limits.overlap_error : limits.overlap_warning, describe_worst_overlap());
  if (is_error) throw AgreedError(fmt::format("at step {} {}", step_, what), true);
  has_warned_ = true;
  if (communicator_.is_root()) note(what, true);
}

template class Simulation::EngineOf<2>;
template class Simulation::EngineOf<3>;

}  // namespace barchan
