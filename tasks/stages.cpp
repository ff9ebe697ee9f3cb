#include <barchan/tasks/stages.hpp>

#include <limits>
#include <span>
#include <string>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/check_walls.hpp>
#include <barchan/tasks/suspects.hpp>
#include <barchan/tasks/view.hpp>

namespace barchan {
namespace {

constexpr std::int64_t kStageCheck = 100;  // steps between looks at the kinetic ratio

/// How many particles of all ranks lie in a wall, and how the first of them does. Collective.
struct Intruders {
  std::int64_t count = 0;
  std::string first;
};
template <int Dim>
Intruders intruders(const RunParts<Dim>& run, std::size_t w) {
  const World<Dim>& world = run.world;
  Intruders found;
  std::int64_t lowest = std::numeric_limits<std::int64_t>::max();
  for_each_owned(run.strip, [&](const OwnedParticle& p) {
    const WallFoot foot = world.wall_shapes[w].foot(world.walls[w].point, p.position.data());
    const auto how = intrusion(world.wall_specs[w], foot, p, Dim);
    if (!how) return;
    ++found.count;
    if (lowest < p.id) return;
    lowest = p.id;
    found.first = *how;
  });
  run.communicator.allreduce_sum(std::span(&found.count, 1));
  std::int64_t top = -lowest;
  run.communicator.allreduce_max(std::span(&top, 1));
  found.first = run.communicator.first_error(lowest == -top ? found.first : "");
  return found;
}

}  // namespace

bool Stages::time_is_over(std::int64_t step) const {
  return time_in_it(step) >= spec().max_time - 0.5 * model_.time.step;
}

bool Stages::may_end(std::int64_t step) const {
  const std::int64_t steps = step - begin_;
  return time_is_over(step) ||
         (spec().kinetic_ratio > 0.0 && steps > 0 && steps % kStageCheck == 0);
}

template <int Dim>
bool show_walls(RunParts<Dim>& run, const Stages& stages, std::int64_t step) {
  bool has_changed = false;
  for (std::size_t w = 0; w < run.world.walls.size(); ++w) {
    const bool is_active = run.world.wall_specs[w].from_stage <= stages.current();
    if (is_active == run.world.walls[w].is_active) continue;
    run.world.walls[w].is_active = is_active;
    has_changed = true;
    const Intruders found = intruders(run, w);
    if (found.count == 0) continue;
    throw AgreedError(fmt::format(
        "at step {} {} appears with stage '{}' where particles are: {}{}; let it appear elsewhere "
        "or later, or take particles away from there",
        step, name_of_wall(run.model, static_cast<std::int32_t>(w)), stages.spec().name,
        found.first, found.count == 1 ? "" : fmt::format(", and {} more", found.count - 1)));
  }
  return has_changed;
}

template bool show_walls(RunParts<2>&, const Stages&, std::int64_t);
template bool show_walls(RunParts<3>&, const Stages&, std::int64_t);

}  // namespace barchan
