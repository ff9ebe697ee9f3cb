#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/base/vec_text.hpp>
#include <barchan/tasks/engine.hpp>

// What a run says that goes wrong or must let particles go: with id, position, velocity and
// partners. Who notices: engine_watch.cpp.

namespace barchan {
namespace {

constexpr std::size_t kMostPartners = 6;  // that a message names

/// What goes wrong in a step, in the order in which it is told.
enum Kind : std::int64_t { Passed, Fast, Overloaded };

std::string plural(std::int64_t count, const char* word) {
  return fmt::format("{} {}{}", count, word, count == 1 ? "" : "s");
}

}  // namespace

template <int Dim>
void Simulation::EngineOf<Dim>::note(std::string text, bool is_warning) {
  notes_.push_back({fmt::format("step {}: {}", step_, text), is_warning});
}

/// The text of the rank with the largest number; of equal ones, the lowest rank.
template <int Dim>
std::string Simulation::EngineOf<Dim>::from_rank_with_most(double mine, const std::string& text) {
  const auto numbers = communicator_.gather(std::as_bytes(std::span(&mine, 1)));
  const auto texts = communicator_.gather(text);
  std::string chosen = text;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t r = 0; r < numbers.size(); ++r) {
    double number = 0.0;
    std::memcpy(&number, numbers[r].data(), sizeof number);
    if (number <= most) continue;
    most = number;
    chosen = texts[r];
  }
  return communicator_.bcast(chosen);
}

template <int Dim>
std::string Simulation::EngineOf<Dim>::describe(const Suspect& s,
                                                const typename Lane<Dim>::Partners& touched) const {
  const std::string text = fmt::format("particle {} at {} with velocity {}", s.id,
                                       in_brackets(s.position, Dim), in_brackets(s.velocity, Dim));
  std::vector<std::string> names;
  for (const std::int64_t id : touched.ids) names.push_back(fmt::format("particle {}", id));
  for (const std::int32_t w : touched.walls)
    names.push_back("wall '" + model_.walls[static_cast<std::size_t>(w)].name + "'");
  if (names.empty()) return text + ", touching nothing";
  const std::size_t more = names.size() - std::min(names.size(), kMostPartners);
  names.resize(names.size() - more);
  return fmt::format("{}, touching {}{}", text, fmt::join(names, ", "),
                     more == 0 ? "" : fmt::format(" and {} more", more));
}

/// Every rank looks among its own particles, so that where the cuts are is not in the text.
template <int Dim>
typename Lane<Dim>::Partners Simulation::EngineOf<Dim>::partners_of(const Suspect& s) {
  std::vector<std::int64_t> mine;
  for (int l = 0; l < strip_->num_lanes(); ++l) strip_->lane(l).find_touching(s, mine);
  typename Lane<Dim>::Partners found;
  for (const auto& piece : communicator_.gather(std::as_bytes(std::span(mine)))) {
    const std::size_t known = found.ids.size();
    found.ids.resize(known + piece.size() / sizeof(std::int64_t));
    if (!piece.empty()) std::memcpy(found.ids.data() + known, piece.data(), piece.size());
  }
  std::sort(found.ids.begin(), found.ids.end());
  for (std::size_t w = 0; w < world_.walls.size(); ++w) {
    const WallState& wall = world_.walls[w];
    if (wall.is_active && world_.wall_shapes[w].foot(wall.point, s.position).distance < s.radius)
      found.walls.push_back(static_cast<std::int32_t>(w));
  }
  return found;
}

template <int Dim>
std::string Simulation::EngineOf<Dim>::describe_fastest() {
  Suspect fastest;
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    const std::int32_t row = strip_->lane(l).fastest_row();
    if (row < 0) continue;
    const Suspect s = strip_->lane(l).suspect(row);
    if (s.speed2 > fastest.speed2) fastest = s;
  }
  const std::string bytes = from_rank_with_most(
      fastest.speed2, {reinterpret_cast<const char*>(&fastest), sizeof fastest});
  std::memcpy(&fastest, bytes.data(), sizeof fastest);
  if (fastest.id == 0) return "no particle is left";
  return "the fastest is " + communicator_.bcast(describe(fastest, partners_of(fastest)));
}

template <int Dim>
std::string Simulation::EngineOf<Dim>::describe_worst_overlap() {
  strip_->complete_halo();
  WorstOverlap worst;
  const auto take = [&worst](const WorstOverlap& other) {
    if (other.is_worse_than(worst)) worst = other;
  };
  for (int l = 0; l < strip_->num_lanes(); ++l) take(strip_->lane(l).worst_overlap());
  for (const auto& bytes : communicator_.gather(std::as_bytes(std::span(&worst, 1)))) {
    WorstOverlap of_rank;
    std::memcpy(&of_rank, bytes.data(), sizeof of_rank);
    take(of_rank);
  }
  return communicator_.bcast("now it is largest between " + describe(worst));
}

template <int Dim>
std::string Simulation::EngineOf<Dim>::describe(const WorstOverlap& worst) const {
  const std::string with =
      worst.wall >= 0 ? "wall '" + model_.walls[static_cast<std::size_t>(worst.wall)].name + "'"
                      : fmt::format("particle {}", worst.with);
  return fmt::format("particle {} at {} and {}: {:.3g} m, {:.3g} of the smaller radius", worst.id,
                     in_brackets(worst.position, Dim), with, worst.overlap, worst.share);
}

template <int Dim>
void Simulation::EngineOf<Dim>::report_outrun(const CheckNumbers& answer) {
  constexpr int kSteps = 2 * RebuildSchedule::kLag;  // until somebody knows of a new speed
  throw AgreedError(fmt::format(
      "at step {} a particle or wall had moved {:.3g} m since the lists were built, more than half "
      "the skin of {:.3g} m (largest speed {:.3g} m/s): contacts may have been missed; {}; {}",
      step_, answer.distance, world_.skin, answer.speed, describe_fastest(),
      remedy_for_travel(std::max(answer.distance, kSteps * world_.dt * answer.speed))));
}

/// For a travel beyond half the skin, whether in one step or since lists were built. A skin wider
/// than particles would not mend what goes wild.
template <int Dim>
std::string Simulation::EngineOf<Dim>::remedy_for_travel(double travel) const {
  if (2.1 * travel > scale_.reach)
    return "a run from step 0 with a smaller time.step, more damping or less overlap would help";
  return fmt::format(
      "search.skin = {:.2g} or more allows for it, also from a checkpoint before; so does a "
      "smaller time.step, from step 0 on",
      2.1 * travel);
}

/// Every rank that sees the two says the same.
template <int Dim>
void Simulation::EngineOf<Dim>::report_passage(const Passage& p) const {
  const auto name = [](const Suspect& s) {
    return fmt::format("particle {} at {} with velocity {} and radius {:.4g} m", s.id,
                       in_brackets(s.position, Dim), in_brackets(s.velocity, Dim), s.radius);
  };
  const bool is_wall = p.second.id == 0;
  const double radius = is_wall ? p.first.radius : std::min(p.first.radius, p.second.radius);
  const bool is_quick = p.travel > radius;
  // So stiff that half the radius stops them, in steps of a fifth of the limit. A contact that was
  // too soft holds the energy of an overlap of the radius.
  const double speed = p.travel / world_.dt, kept = is_quick ? 0.0 : p.stiffness;
  const double stiffness = 4.0 * (p.mass * speed * speed / (radius * radius) + kept);
  const double step = 0.4 * std::sqrt(p.mass / std::max(stiffness, p.stiffness));
  const bool is_stiffer = stiffness > p.stiffness, is_shorter = 0.9 * step < world_.dt;
  throw StepError(
      {step_, Passed, p.first.id, p.second.id},
      fmt::format(
          "at step {} {} has passed {}: they moved {:.3g} m against each other in one step, {} "
          "{:.3g} m{}; a run from step 0 with {}{}{} would hold them apart",
          step_, name(p.first),
          is_wall ? "wall '" + model_.walls[static_cast<std::size_t>(p.wall)].name + "'"
                  : name(p.second),
          p.travel, is_quick ? "more than the smaller radius," : "with a radius of", radius,
          is_quick ? "" : ", and their contact was too soft to stop them",
          is_stiffer ? fmt::format("normal_stiffness = {:.2g}", 1.1 * stiffness) : "",
          is_stiffer && is_shorter ? " and " : "",
          is_shorter ? fmt::format("time.step = {:.2g}", 0.9 * step) : ""));
}

/// This rank alone knows: the others may be in the midst of the next step.
template <int Dim>
void Simulation::EngineOf<Dim>::report_fast(int l) {
  const Lane<Dim>& lane = strip_->lane(l);
  const std::int32_t row = lane.first_fast_row();
  const Suspect s = lane.suspect(row);
  const double* was =
      lane.store().reference.data() + std::size_t{Dim} * static_cast<std::size_t>(row);
  const double travel = world_.dt * std::sqrt(s.speed2);
  throw StepError(
      {step_, Fast, s.id, 0},
      fmt::format("in step {} {} (at {} when lists were last built): {}", step_,
                  describe(s, lane.partners_before_step(row)), in_brackets(was, Dim),
                  s.speed2 < std::numeric_limits<double>::max()
                      ? fmt::format("it moves {:.3g} m in one step, more than half of the smallest "
                                    "radius ({:.3g} m) and of the skin, so that contacts may be "
                                    "missed; {}",
                                    travel, 2.0 * world_.quick_travel, remedy_for_travel(travel))
                      : "its state is no longer finite; a run from step 0 with a smaller "
                        "time.step, more damping or less overlap would help"));
}

/// This rank alone knows, as with a fast particle. The strongest force is told first, and nothing
/// else: what is near depends on the cuts.
template <int Dim>
void Simulation::EngineOf<Dim>::report_overload(int l) {
  const double force = strip_->lane(l).overload();
  throw StepError(
      {step_, Overloaded, -std::bit_cast<std::int64_t>(force), 0},
      fmt::format(
          "in step {} the contacts of one particle press with {:.4g} N in all; sums of forces are "
          "exact up to {:.4g} N, which follows from limits.overlap_error; less overlap at the "
          "start or a smaller time.step would help, or a larger limits.overlap_error; a lower "
          "limits.overlap_warning says earlier where overlaps are large",
          step_, force, world_.grain.most()));
}

template <int Dim>
void Simulation::EngineOf<Dim>::report_departures(const std::vector<Departure>& left) {
  const Departure& first = left.front();
  throw AgreedError(
      fmt::format(
          "at step {} particle {} is out of the domain, at {} with velocity {}{}: "
          "domain.outside = \"delete\" takes particles out, also from a checkpoint on; for a "
          "larger domain or a wall there, start the run from step 0",
          step_, first.id, in_brackets(first.position, Dim), in_brackets(first.velocity, Dim),
          left.size() == 1 ? "" : fmt::format(", and {} more are", left.size() - 1)),
      true);
}

template <int Dim>
void Simulation::EngineOf<Dim>::note_departures(const std::vector<Departure>& left,
                                                std::int64_t contacts, std::int64_t bonds) {
  note(fmt::format("{} left the domain, the first is particle {} at {}; {} and {} went with it",
                   plural(static_cast<std::int64_t>(left.size()), "particle"), left.front().id,
                   in_brackets(left.front().position, Dim), plural(contacts, "contact"),
                   plural(bonds, "bond")));
}

template class Simulation::EngineOf<2>;
template class Simulation::EngineOf<3>;

}  // namespace barchan
