#include <barchan/tasks/suspects.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/base/vec_text.hpp>
#include <barchan/core/brick/diagnose.hpp>

namespace barchan {
namespace {

constexpr std::size_t kMostPartners = 6;  // that a message names

/// Every rank looks among its own particles, so that where the cuts are is not in the text.
template <int Dim>
Partners partners_of(const RunParts<Dim>& run, const Suspect& s) {
  std::vector<std::int64_t> mine;
  for (const Lane<Dim>& lane : run.strip.lanes()) find_touching(lane.brick, s, mine);
  Partners found;
  found.ids = run.communicator.gather_all(std::span<const std::int64_t>(mine));
  std::sort(found.ids.begin(), found.ids.end());
  for (std::size_t w = 0; w < run.world.walls.size(); ++w) {
    const WallState& wall = run.world.walls[w];
    if (wall.is_active && run.world.wall_shapes[w].foot(wall.point, s.position).distance < s.radius)
      found.walls.push_back(static_cast<std::int32_t>(w));
  }
  return found;
}

}  // namespace

std::string name_of_wall(const Model& model, std::int32_t wall) {
  return "wall '" + model.walls[static_cast<std::size_t>(wall)].name + "'";
}

template <int Dim>
std::string describe(const Model& model, const Suspect& s, const Partners& touched) {
  const std::string text = fmt::format("particle {} at {} with velocity {}", s.id,
                                       in_brackets(s.position, Dim), in_brackets(s.velocity, Dim));
  std::vector<std::string> names;
  for (const std::int64_t id : touched.ids) names.push_back(fmt::format("particle {}", id));
  for (const std::int32_t w : touched.walls) names.push_back(name_of_wall(model, w));
  if (names.empty()) return text + ", touching nothing";
  const std::size_t more = names.size() - std::min(names.size(), kMostPartners);
  names.resize(names.size() - more);
  return fmt::format("{}, touching {}{}", text, fmt::join(names, ", "),
                     more == 0 ? "" : fmt::format(" and {} more", more));
}

template <int Dim>
std::string describe_fastest(RunParts<Dim>& run) {
  Suspect fastest;
  const auto take = [&fastest](const Suspect& s) {
    if (s.speed2 > fastest.speed2) fastest = s;
  };
  for (const Lane<Dim>& lane : run.strip.lanes()) {
    const std::int32_t row = fastest_row(lane.brick);
    if (row >= 0) take(suspect_of(lane.brick.store, row));
  }
  for (const Suspect& s : run.communicator.gather_all(std::span<const Suspect>(&fastest, 1)))
    take(s);
  run.communicator.bcast(std::as_writable_bytes(std::span(&fastest, 1)));
  if (fastest.id == 0) return "no particle is left";
  return "the fastest is " +
         run.communicator.bcast(describe<Dim>(run.model, fastest, partners_of(run, fastest)));
}

namespace {

/// Of what every lane knows the worst, on all ranks. Collective.
template <class Worst, int Dim>
Worst worst_of_all(RunParts<Dim>& run, Worst (*worst_of)(const Brick<Dim>&)) {
  run.strip.complete_halo();
  Worst worst;
  const auto take = [&worst](const Worst& other) {
    if (other.is_worse_than(worst)) worst = other;
  };
  for (Lane<Dim>& lane : run.strip.lanes()) take(worst_of(lane.brick));
  for (const auto& of_rank : run.communicator.gather_all(std::span<const Worst>(&worst, 1)))
    take(of_rank);
  run.communicator.bcast(std::as_writable_bytes(std::span(&worst, 1)));
  return worst;
}

/// "particle 3 at [1, 2] and wall 'lid'"
template <int Dim>
std::string names_of(const Model& model, const WorstOverlap& at) {
  return fmt::format(
      "particle {} at {} and {}", at.id, in_brackets(at.position, Dim),
      at.wall >= 0 ? name_of_wall(model, at.wall) : fmt::format("particle {}", at.with));
}

}  // namespace

template <int Dim>
std::string describe_worst_overlap(RunParts<Dim>& run) {
  const auto worst = worst_of_all<WorstOverlap>(run, &worst_overlap<Dim>);
  return fmt::format("now it is largest between {}: {:.3g} m, {:.3g} of the smaller radius",
                     names_of<Dim>(run.model, worst), worst.overlap, worst.share);
}

template <int Dim>
std::string describe_stiffest_contact(RunParts<Dim>& run) {
  const auto worst = worst_of_all<StiffestContact>(run, &stiffest_contact<Dim>);
  return fmt::format("{} overlap by {:.3g} of the smaller radius, so that {:.3g} s is stable",
                     names_of<Dim>(run.model, worst.at), worst.at.share,
                     run.world.dt / worst.step_share);
}

/// A skin wider than particles would not mend what goes wild.
std::string remedy_for_travel(double travel, double reach) {
  if (2.1 * travel > reach)
    return "a run from step 0 with a smaller time.step, more damping or less overlap would help";
  return fmt::format(
      "search.skin = {:.2g} or more allows for it, also from a checkpoint before; so does a "
      "smaller time.step, from step 0 on",
      2.1 * travel);
}

template std::string describe<2>(const Model&, const Suspect&, const Partners&);
template std::string describe<3>(const Model&, const Suspect&, const Partners&);
template std::string describe_fastest(RunParts<2>&);
template std::string describe_fastest(RunParts<3>&);
template std::string describe_worst_overlap(RunParts<2>&);
template std::string describe_worst_overlap(RunParts<3>&);
template std::string describe_stiffest_contact(RunParts<2>&);
template std::string describe_stiffest_contact(RunParts<3>&);

}  // namespace barchan
