#include <barchan/tasks/wrong_step.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/base/vec_text.hpp>
#include <barchan/core/brick/diagnose.hpp>
#include <barchan/tasks/suspects.hpp>

namespace barchan {
namespace {

/// What goes wrong in a step, in the order in which it is told.
enum Kind : std::int64_t { Passed, Fast, Overloaded, Hot };

/// Every rank that sees the two says the same.
template <int Dim>
[[noreturn]] void report_passage(const RunParts<Dim>& run, const Passage& p, std::int64_t step) {
  const auto name = [](const Suspect& s) {
    return fmt::format("particle {} at {} with velocity {} and radius {:.4g} m", s.id,
                       in_brackets(s.position, Dim), in_brackets(s.velocity, Dim), s.radius);
  };
  const bool is_wall = p.second.id == 0;
  const double radius = is_wall ? p.first.radius : std::min(p.first.radius, p.second.radius);
  const bool is_quick = p.travel > radius;
  // So stiff that half the radius stops them, in steps of a fifth of the limit. A contact that was
  // too soft holds the energy of an overlap of the radius.
  const double dt = run.world.last_dt, speed = p.travel / dt, kept = is_quick ? 0.0 : p.stiffness;
  const double stiffness = 4.0 * (p.mass * speed * speed / (radius * radius) + kept);
  const double remedy = 0.4 * std::sqrt(p.mass / std::max(stiffness, p.stiffness));
  const bool is_stiffer = stiffness > p.stiffness, is_shorter = 0.9 * remedy < dt;
  throw StepError(
      {step, Passed, p.first.id, p.second.id},
      fmt::format(
          "at step {} {} has passed {}: they moved {:.3g} m against each other in one step, {} "
          "{:.3g} m{}; a run from step 0 with {}{}{} would hold them apart",
          step, name(p.first), is_wall ? name_of_wall(run.model, p.wall) : name(p.second), p.travel,
          is_quick ? "more than the smaller radius," : "with a radius of", radius,
          is_quick ? "" : ", and their contact was too soft to stop them",
          is_stiffer ? with_law(run.model.contacts.law,
                                [&]<class Law>(Law /*law*/) {
                                  return Law::stiffer(1.1 * stiffness,
                                                      1.1 * stiffness / p.stiffness);
                                })
                     : "",
          is_stiffer && is_shorter ? " and " : "",
          is_shorter ? fmt::format("time.step = {:.2g}", 0.9 * remedy) : ""));
}

template <int Dim>
[[noreturn]] void report_fast(const RunParts<Dim>& run, const Lane<Dim>& lane, std::int64_t step) {
  const std::int32_t row = first_fast_row(lane.brick);
  const Suspect s = suspect_of(lane.brick.store, row);
  const double* was =
      lane.brick.store.reference.data() + std::size_t{Dim} * static_cast<std::size_t>(row);
  const double travel = run.world.dt * std::sqrt(s.speed2);
  throw StepError(
      {step, Fast, s.id, 0},
      fmt::format("in step {} {} (at {} when lists were last built): {}", step,
                  describe<Dim>(run.model, s, partners_before_step(lane.brick, row)),
                  in_brackets(was, Dim),
                  s.speed2 < std::numeric_limits<double>::max()
                      ? fmt::format("it moves {:.3g} m in one step, more than half of the smallest "
                                    "radius ({:.3g} m) and of the skin, so that contacts may be "
                                    "missed; {}",
                                    travel, 2.0 * run.world.quick_travel,
                                    remedy_for_travel(travel, run.scale.reach))
                      : "its state is no longer finite; a run from step 0 with a smaller "
                        "time.step, more damping or less overlap would help"));
}

/// The largest is told first, and nothing else: what is near depends on the cuts.
StepError of_largest(Kind kind, double size, std::int64_t step, const std::string& text) {
  return StepError({step, kind, -std::bit_cast<std::int64_t>(size), 0}, text);
}

std::string overload_text(const ForceGrain& grain, double force, std::int64_t step) {
  return fmt::format(
      "in step {} the contacts of one particle press with {:.4g} N in all; sums of forces are "
      "exact up to {:.4g} N, which follows from limits.overlap_error; less overlap at the "
      "start or a smaller time.step would help, or a larger limits.overlap_error; a lower "
      "limits.overlap_warning says earlier where overlaps are large",
      step, force, grain.most());
}

std::string heat_text(const ForceGrain& grain, double flow, std::int64_t step) {
  return fmt::format(
      "in step {} {:.4g} W flow through the contacts of one particle; sums of flows are "
      "exact up to {:.4g} W, which follows from limits.overlap_error, the temperatures "
      "of the start and of walls, and heat_flux until time.end; a larger "
      "limits.overlap_error or a later time.end would help",
      step, flow, grain.most());
}

template <int Dim>
std::int64_t first_fast_id(const Lane<Dim>& lane) {
  return lane.brick.store.id[static_cast<std::size_t>(first_fast_row(lane.brick))];
}

}  // namespace

template <int Dim>
int wrong_step(const Strip<Dim>& strip, const StepGraph<Dim>& graph) {
  int first = 0;
  for (int l = 0; l < strip.num_lanes(); ++l) {
    const int steps = graph.steps_done(l);
    if (must_stop(strip.lane(l).brick) && (first == 0 || steps < first)) first = steps;
  }
  return first;
}

template <int Dim>
void report_wrong_step(const RunParts<Dim>& run, const StepGraph<Dim>& graph, int nth,
                       std::int64_t step) {
  const Lane<Dim>* fast = nullptr;
  double force = 0.0, flow = 0.0;
  Passage passage;
  for (int l = 0; l < run.strip.num_lanes(); ++l) {
    const Lane<Dim>& lane = run.strip.lane(l);
    if (!must_stop(lane.brick) || graph.steps_done(l) != nth) continue;
    force = std::max(force, overload(lane.brick));
    flow = std::max(flow, heat_overload(lane.brick));
    passage.add(lane.brick.passage);
    if (lane.brick.is_fast && (fast == nullptr || first_fast_id(lane) < first_fast_id(*fast)))
      fast = &lane;
  }
  if (passage.exists()) report_passage(run, passage, step);
  if (fast != nullptr) report_fast(run, *fast, step);
  if (force > 0.0)
    throw of_largest(Overloaded, force, step, overload_text(run.world.grain, force, step));
  throw of_largest(Hot, flow, step, heat_text(run.world.heat.grain, flow, step));
}

template int wrong_step(const Strip<2>&, const StepGraph<2>&);
template int wrong_step(const Strip<3>&, const StepGraph<3>&);
template void report_wrong_step(const RunParts<2>&, const StepGraph<2>&, int, std::int64_t);
template void report_wrong_step(const RunParts<3>&, const StepGraph<3>&, int, std::int64_t);

}  // namespace barchan
