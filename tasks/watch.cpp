#include <barchan/tasks/watch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/base/vec_text.hpp>
#include <barchan/core/brick/diagnose.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/suspects.hpp>

namespace barchan {
namespace {

constexpr std::int64_t kOverlapEvery = 1000;  // steps between looks at overlaps, at least
/// An overlap at which a contact is too stiff for the step.
constexpr double kTooStiff = std::numeric_limits<double>::infinity();

std::string plural(std::int64_t count, const char* word) {
  return fmt::format("{} {}{}", count, word, count == 1 ? "" : "s");
}

template <int Dim>
[[noreturn]] void report_departures(const std::vector<Departure>& left, std::int64_t step) {
  const Departure& first = left.front();
  throw AgreedError(
      fmt::format(
          "at step {} particle {} is out of the domain, at {} with velocity {}{}: "
          "domain.outside = \"delete\" takes particles out, also from a checkpoint on; for a "
          "larger domain or a wall there, start the run from step 0",
          step, first.id, in_brackets(first.position, Dim), in_brackets(first.velocity, Dim),
          left.size() == 1 ? "" : fmt::format(", and {} more are", left.size() - 1)),
      true);
}

template <int Dim>
[[noreturn]] void report_outrun(RunParts<Dim>& run, const CheckNumbers& answer, std::int64_t step) {
  constexpr int kSteps = 2 * RebuildSchedule::kLag;  // until somebody knows of a new speed
  throw AgreedError(fmt::format(
      "at step {} a particle or wall had moved {:.3g} m since the lists were built, more than half "
      "the skin of {:.3g} m (largest speed {:.3g} m/s): contacts may have been missed; {}; {}",
      step, answer.distance, run.world.skin, answer.speed, describe_fastest(run),
      remedy_for_travel(std::max(answer.distance, kSteps * run.world.dt * answer.speed),
                        run.scale.reach)));
}

}  // namespace

template <int Dim>
void Watch<Dim>::look(std::int64_t step, CheckNumbers& mine) {
  if (step / kOverlapEvery != overlap_watched_at_ / kOverlapEvery) {
    overlap_watched_at_ = step;
    run_.strip.complete_halo();
    std::vector<double> shares(run_.strip.lanes().size(), 0.0);
    graph_.for_each_lane([&](int l) {
      const Brick<Dim>& brick = run_.strip.lane(l).brick;
      double& share = shares[static_cast<std::size_t>(l)];
      share = worst_overlap(brick).share;
      if (!run_.model.time.allow_unstable && stiffest_contact(brick).step_share > 1.0)
        share = kTooStiff;
    });
    for (const double share : shares) see_overlap(share);
  }
  for (const Lane<Dim>& lane : run_.strip.lanes())
    mine.outside = std::max(mine.outside, last_outside(lane.brick));
  mine.overlap = std::exchange(overlap_, 0.0);
}

template <int Dim>
void Watch<Dim>::count(CheckNumbers& mine) const {
  mine.particles = run_.strip.num_owned();
  for (const Lane<Dim>& lane : run_.strip.lanes())
    mine.imbalance += lane.rebuild.carry().imbalance();
}

template <int Dim>
bool Watch<Dim>::is_harmless(const CheckNumbers& answer) const {
  const LimitSpec& limits = run_.model.limits;
  return answer.distance <= 0.5 * run_.world.skin && std::isfinite(answer.speed) &&
         answer.overlap < kTooStiff && answer.outside == 0 &&
         answer.overlap <= limits.overlap_warning && answer.overlap <= limits.overlap_error &&
         answer.particles == population_.size && answer.imbalance == LinkCounts{};
}

template <int Dim>
void Watch<Dim>::judge(std::int64_t step, const CheckNumbers& answer) {
  must_remove_ = false;
  if (is_harmless(answer)) return;
  if (!std::isfinite(answer.distance) || !std::isfinite(answer.speed)) {
    throw AgreedError(
        fmt::format("at step {} the state is no longer finite: {}; start the run from step 0 with "
                    "a smaller time.step, more damping or less overlap",
                    step, describe_fastest(run_)));
  }
  judge_balance(step, answer);
  if (answer.outside > 0 && run_.model.domain.outside == OutsidePolicy::Error) {
    const auto left = departures(step);
    if (!left.empty()) report_departures<Dim>(left, step);
  }
  if (answer.distance > 0.5 * run_.world.skin) report_outrun(run_, answer, step);
  judge_overlap(step, answer.overlap);
  must_remove_ = answer.outside > 0;
}

template <int Dim>
void Watch<Dim>::judge_balance(std::int64_t step, const CheckNumbers& answer) const {
  std::vector<std::string> wrong;
  const auto compare = [&](std::int64_t difference, const char* one, const char* many) {
    if (difference == 0) return;
    const std::int64_t count = std::abs(difference);
    wrong.push_back(fmt::format("{} {} too {}", count, count == 1 ? one : many,
                                difference < 0 ? "few" : "many"));
  };
  compare(answer.particles - population_.size, "particle", "particles");
  compare(answer.imbalance.contacts, "contact", "contacts");
  compare(answer.imbalance.wall_contacts, "contact with a wall", "contacts with walls");
  compare(answer.imbalance.bonds, "bond", "bonds");
  if (wrong.empty()) return;
  throw AgreedError(
      fmt::format("at step {} all ranks together have {} since lists were rebuilt: a fault of the "
                  "program or the machine; restart from the last checkpoint, and report this",
                  step, fmt::join(wrong, ", ")));
}

template <int Dim>
void Watch<Dim>::judge_overlap(std::int64_t step, double share) {
  if (share == kTooStiff) {
    throw AgreedError(fmt::format(
        "at step {} time.step = {:g} s has become unstable: {}; start the run from step 0 with a "
        "smaller time.step, or with contact.reference_speed as fast as contacts are struck",
        step, run_.world.dt, describe_stiffest_contact(run_)));
  }
  const LimitSpec& limits = run_.model.limits;
  const bool is_error = share > limits.overlap_error;
  if (!is_error && (has_warned_ || share <= limits.overlap_warning)) return;
  const std::string what = fmt::format(
      "an overlap of {:.3g} of the smaller radius is beyond limits.{} = {:.3g}; {}; a higher "
      "limit lets the run continue, also from a checkpoint on; for stiffer contacts, start the run "
      "from step 0",
      share, is_error ? "overlap_error" : "overlap_warning",
      is_error ? limits.overlap_error : limits.overlap_warning, describe_worst_overlap(run_));
  if (is_error) throw AgreedError(fmt::format("at step {} {}", step, what), true);
  has_warned_ = true;
  if (run_.communicator.is_root()) notes_.add(step, what, true);
}

template <int Dim>
void Watch<Dim>::judge_plates(std::int64_t step) const {
  const World<Dim>& world = run_.world;
  for (std::size_t w = 0; w < world.walls.size(); ++w) {
    const WallState& wall = world.walls[w];
    const double travel = world.dt * wall.velocity.norm();
    if (!wall.is_active || run_.model.walls[w].kind != WallKind::Plate ||
        travel <= world.most_travel(world.skin))
      continue;
    throw AgreedError(fmt::format(
        "at step {} {} moves {:.3g} m in one step, more than half of the smallest radius "
        "({:.3g} m), so that it may pass particles unseen; {}",
        step, name_of_wall(run_.model, static_cast<std::int32_t>(w)), travel,
        2.0 * world.quick_travel, remedy_for_travel(travel, run_.scale.reach)));
  }
}

/// Those that are out now, the same on every rank, by id.
template <int Dim>
std::vector<Departure> Watch<Dim>::departures(std::int64_t step) const {
  std::vector<Departure> mine;
  for (const Lane<Dim>& lane : run_.strip.lanes()) {
    const auto outside = barchan::outside(lane.brick, step);
    mine.insert(mine.end(), outside.begin(), outside.end());
  }
  const Communicator& communicator = run_.communicator;
  const auto all = communicator.gather_all(std::span<const Departure>(mine));
  const std::string bytes = communicator.bcast(
      std::string(reinterpret_cast<const char*>(all.data()), all.size() * sizeof(Departure)));
  std::vector<Departure> found(bytes.size() / sizeof(Departure));
  if (found.empty()) return found;
  std::memcpy(found.data(), bytes.data(), bytes.size());
  std::sort(found.begin(), found.end(),
            [](const Departure& p, const Departure& q) { return p.id < q.id; });
  agree_between_steps(communicator, fmt::format("step {}: on_departure", step), [&] {
    if (communicator.is_root() && population_.tell_departures) population_.tell_departures(found);
  });
  return found;
}

template <int Dim>
bool Watch<Dim>::remove_outside(std::int64_t step) {
  if (!std::exchange(must_remove_, false)) return false;
  const std::vector<Departure> left = departures(step);
  if (left.empty()) return false;  // it came back meanwhile
  std::vector<std::int64_t> ids;
  ids.reserve(left.size());
  for (const Departure& d : left) ids.push_back(d.id);
  LinkCounts gone;
  for (Lane<Dim>& lane : run_.strip.lanes()) gone += lane.rebuild.remove(ids);
  std::int64_t sums[] = {gone.contacts, gone.wall_contacts, gone.bonds};
  run_.communicator.allreduce_sum(std::span<std::int64_t>(sums));
  const auto count = static_cast<std::int64_t>(left.size());
  population_.size -= count;
  population_.left.particles += count;
  population_.left.links += {sums[0], sums[1], sums[2]};
  if (run_.communicator.is_root()) {
    notes_.add(step, fmt::format("{} left the domain, the first is particle {} at {}; {} and {} "
                                 "went with it",
                                 plural(count, "particle"), left.front().id,
                                 in_brackets(left.front().position, Dim),
                                 plural(sums[0] + sums[1], "contact"), plural(sums[2], "bond")));
  }
  return true;
}

template class Watch<2>;
template class Watch<3>;

}  // namespace barchan
