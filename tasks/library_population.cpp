// Particles that come and go between steps as a caller wants it.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/base/vec_text.hpp>
#include <barchan/core/generators/check_walls.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/at_rest.hpp>
#include <barchan/tasks/engine.hpp>
#include <barchan/tasks/forecast.hpp>
#include <barchan/tasks/stability.hpp>
#include <barchan/tasks/strip_plan.hpp>

namespace barchan {
namespace {

template <int Dim>
void check_room(const RunParts<Dim>& run, const ParticleData& p) {
  const World<Dim>& world = run.world;
  for (std::size_t w = 0; w < world.walls.size(); ++w) {
    if (!world.walls[w].is_active) continue;
    const WallFoot foot = world.wall_shapes[w].foot(world.walls[w].point, p.position.data());
    if (const auto how = intrusion(world.wall_specs[w], foot, p, Dim))
      throw InputError("Simulation::add: " + *how, "add it elsewhere");
  }
  for (const Lane<Dim>& lane : run.strip.lanes()) {
    const ParticleStore<Dim>& store = lane.brick.store;
    for (std::int32_t i = 0; i < store.num_owned; ++i) {
      const double least = std::min(p.radius, store.radius(i));
      const double reach = p.radius + store.radius(i) - kGrossOverlap * least;
      if (distance2<Dim>(world.grid.box(), p.position.data(), store.x(i)) >= reach * reach)
        continue;
      throw InputError(
          fmt::format(
              "Simulation::add: particle {} at {} overlaps particle {} by more than half of "
              "the smaller radius",
              p.id, in_brackets(p.position, Dim), store.id[static_cast<std::size_t>(i)]),
          "add it elsewhere, or later");
    }
  }
}

/// The grid and its cells were made for the start.
template <int Dim>
void check_size(const RunParts<Dim>& run, const ParticleSet& newcomers) {
  const double reach = search_reach(run.model, newcomers, run.scale.skin);
  if (reach <= run.scale.reach * (1.0 + 1e-12)) return;
  const auto largest = std::max_element(
      newcomers.particles.begin(), newcomers.particles.end(),
      [](const ParticleData& a, const ParticleData& b) { return a.radius < b.radius; });
  throw InputError(
      fmt::format("Simulation::add: particle {} has a radius of {:.6g} m, which is more "
                  "than cells of {:.6g} m allow",
                  largest->id, largest->radius, run.scale.reach),
      "start with a particle as large, somewhere out of the way");
}

/// Together with those that are there. The same verdict on any ranks.
/// @param there  on rank 0
void check_step_with(const Model& model, ParticleSet there, const ParticleSet& newcomers) {
  there.particles.insert(there.particles.end(), newcomers.particles.begin(),
                         newcomers.particles.end());
  check_time_step(model, step_limits(model, there));
}

}  // namespace

template <int Dim>
std::vector<ParticlePlace> Simulation::EngineOf<Dim>::find_all(std::span<const std::int64_t> ids,
                                                               const char* call) {
  const ParticleIndex& places = index();
  std::vector<ParticlePlace> found(ids.size());
  std::vector<std::int64_t> is_known(ids.size(), 0);
  for (std::size_t k = 0; k < ids.size(); ++k) {
    found[k] = places.find(ids.subspan(k, 1)).first;
    is_known[k] = found[k].lane < 0 ? 0 : 1;
  }
  communicator_.allreduce_sum(std::span<std::int64_t>(is_known));
  const auto unknown = std::find(is_known.begin(), is_known.end(), 0);
  if (unknown == is_known.end()) return found;
  throw InputError(fmt::format("Simulation::{}: there is no particle {}", call,
                               ids[static_cast<std::size_t>(unknown - is_known.begin())]),
                   "gather() says which there are");
}

template <int Dim>
void Simulation::EngineOf<Dim>::remove(std::span<const std::int64_t> ids) {
  (void)find_all(ids, "remove");
  begin_account();
  for (Lane<Dim>& lane : parts_.strip.lanes()) lane.rebuild.remove(ids);
  const auto count = static_cast<std::int64_t>(ids.size());
  population_.size -= count;
  schedule_.amend(step_, -count, 0.0);
  renew_lists();
}

template <int Dim>
void Simulation::EngineOf<Dim>::add(const ParticleSet& newcomers) {
  agree(communicator_, [&] {
    check_particles(model_, newcomers);
    check_precision(model_, newcomers);
    check_size(parts_, newcomers);
    for (const ParticleData& p : newcomers.particles) {
      if (index().find(std::span(&p.id, 1)).first.lane >= 0)
        throw InputError(fmt::format("Simulation::add: there is a particle {} already", p.id),
                         "give ids that are free");
      check_room(parts_, p);
    }
  });
  const ParticleSet there = gather_lightest(parts_);
  agree(communicator_, [&] {
    if (communicator_.is_root()) check_step_with(model_, there, newcomers);
  });
  begin_account();
  double speed = 0.0;
  for (const ParticleData& p : newcomers.particles) {
    speed = std::max(speed, p.velocity.norm());
    parts_.world.quick_travel = std::min(parts_.world.quick_travel, 0.5 * p.radius);
  }
  const auto count = static_cast<std::int64_t>(newcomers.particles.size());
  population_.size += count;
  schedule_.amend(step_, count, speed);
  parts_.rebuild.take_in(newcomers.particles);
  renew_lists();
  if (!parts_.world.accounts) return;
  for (const ParticleData& p : newcomers.particles) {
    const ParticlePlace place = index().find(std::span(&p.id, 1)).first;
    book_kinetic(std::span(&place, 1), 1.0);
  }
}

template std::vector<ParticlePlace> Simulation::EngineOf<2>::find_all(std::span<const std::int64_t>,
                                                                      const char*);
template void Simulation::EngineOf<2>::remove(std::span<const std::int64_t>);
template void Simulation::EngineOf<2>::add(const ParticleSet&);
template std::vector<ParticlePlace> Simulation::EngineOf<3>::find_all(std::span<const std::int64_t>,
                                                                      const char*);
template void Simulation::EngineOf<3>::remove(std::span<const std::int64_t>);
template void Simulation::EngineOf<3>::add(const ParticleSet&);

}  // namespace barchan
