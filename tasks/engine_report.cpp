#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/error.hpp>
#include <barchan/tasks/engine.hpp>

// What a run says that goes wrong or must let particles go: with id, position, velocity and
// partners. Who notices: engine_watch.cpp.

namespace barchan {
namespace {

constexpr std::size_t kMostPartners = 6;  // that a message names

std::string in_brackets(const double* v, int count) {
  return fmt::format("({:.6g})", fmt::join(v, v + count, ", "));
}

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
std::string Simulation::EngineOf<Dim>::describe(int l, std::int32_t row) {
  Lane<Dim>& lane = strip_->lane(l);
  const auto& store = lane.store();
  const auto at = static_cast<std::size_t>(row);
  std::string text = fmt::format("particle {} at {} with velocity {}", store.id[at],
                                 in_brackets(store.x(row), Dim), in_brackets(store.v(row), Dim));
  const auto touched = lane.partners(row);
  std::vector<std::string> names;
  for (const std::int64_t id : touched.ids) names.push_back(fmt::format("particle {}", id));
  for (const std::int32_t w : touched.walls)
    names.push_back("wall '" + model_.walls[static_cast<std::size_t>(w)].name + "'");
  if (names.empty()) return text + ", touching nothing";
  const std::size_t more = names.size() - std::min(names.size(), kMostPartners);
  names.resize(names.size() - more);
  text += fmt::format(", touching {}", fmt::join(names, ", "));
  return more == 0 ? text : text + fmt::format(" and {} more", more);
}

template <int Dim>
std::string Simulation::EngineOf<Dim>::describe_fastest() {
  double most = -1.0;
  std::string text = "no particle is left";
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    const std::int32_t row = strip_->lane(l).fastest_row();
    if (row < 0) continue;
    double v2 = 0.0;
    for (int c = 0; c < Dim; ++c) v2 += std::pow(strip_->lane(l).store().v(row)[c], 2);
    if (!std::isfinite(v2)) v2 = std::numeric_limits<double>::max();
    if (v2 <= most) continue;
    most = v2;
    text = describe(l, row);
  }
  return "the fastest is " + from_rank_with_most(most, text);
}

template <int Dim>
std::string Simulation::EngineOf<Dim>::describe_worst_overlap() {
  strip_->complete_halo();
  WorstOverlap worst;
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    const WorstOverlap lane = strip_->lane(l).worst_overlap();
    if (lane.share > worst.share) worst = lane;
  }
  const std::string with =
      worst.wall >= 0 ? "wall '" + model_.walls[static_cast<std::size_t>(worst.wall)].name + "'"
                      : fmt::format("particle {}", worst.with);
  return from_rank_with_most(
      worst.share,
      fmt::format("now it is largest between particle {} at {} and {}: {:.3g} m, {:.3g} "
                  "of the smaller radius",
                  worst.id, in_brackets(worst.position, Dim), with, worst.overlap, worst.share));
}

template <int Dim>
void Simulation::EngineOf<Dim>::report_outrun(const CheckNumbers& answer) {
  throw AgreedError(fmt::format(
      "at step {} a particle or wall had moved {:.3g} m since the lists were built, more than half "
      "the skin of {:.3g} m (largest speed {:.3g} m/s): contacts may have been missed; {}; give a "
      "larger search.skin or a smaller time.step",
      step_, answer.distance, world_.skin, answer.speed, describe_fastest()));
}

/// This rank alone knows: the others may be in the midst of the next step.
template <int Dim>
void Simulation::EngineOf<Dim>::report_fast(int l) {
  Lane<Dim>& lane = strip_->lane(l);
  const std::int32_t row = lane.fastest_row();
  const auto& store = lane.store();
  bool is_finite = true;
  for (int c = 0; c < Dim; ++c)
    is_finite = is_finite && std::isfinite(store.v(row)[c] + store.x(row)[c]);
  const double* was = store.reference.data() + std::size_t{Dim} * static_cast<std::size_t>(row);
  throw RunError(fmt::format(
      "in step {} {} (at {} when lists were last built): {} a smaller time.step, more damping or "
      "less overlap at the start would help",
      step_, describe(l, row), in_brackets(was, Dim),
      is_finite
          ? fmt::format("it moves farther in one step than half the skin of {:.3g} m, so that "
                        "contacts may be missed;",
                        world_.skin)
          : "its state is no longer finite;"));
}

template <int Dim>
void Simulation::EngineOf<Dim>::report_departures(const std::vector<Departure>& left) {
  const Departure& first = left.front();
  throw AgreedError(
      fmt::format("at step {} particle {} is out of the domain, at {} with velocity {}{}: enlarge "
                  "domain.lo and domain.hi, put a wall there, or let particles go by "
                  "domain.outside = \"delete\"",
                  step_, first.id, in_brackets(first.position, Dim),
                  in_brackets(first.velocity, Dim),
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
