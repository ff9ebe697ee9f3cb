// Walls that callers move.
#include <optional>
#include <string>

#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/check_walls.hpp>
#include <barchan/core/model/validate.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/engine.hpp>

namespace barchan {
namespace {

constexpr const char* kSetPose = "Simulation::wall().set_pose: ";

/// Errors: InputError, as agree() has it, for a wall that would stand in a particle.
template <int Dim>
void check_free(const RunParts<Dim>& run, const WallSpec& spec, const Vec3& point) {
  const WallShape<Dim> shape(spec, run.world.grid.box());
  for_each_owned(run.strip, [&](const OwnedParticle& p) {
    if (const auto how = intrusion(spec, shape.foot(point, p.position.data()), p, Dim))
      throw InputError(kSetPose + *how, "put the wall elsewhere, or move it by set_velocity");
  });
}

}  // namespace

template <int Dim>
void Simulation::EngineOf<Dim>::set_wall_velocity(std::size_t wall, const Vec3& velocity) {
  parts_.world.walls[wall].velocity = velocity;
  if (velocity.norm() <= schedule_.speed()) return;
  schedule_.amend(step_, 0, velocity.norm());
  renew_lists();
}

template <int Dim>
void Simulation::EngineOf<Dim>::set_wall_load(std::size_t wall, double load) {
  model_.walls[wall].load = load;
  parts_.world.wall_specs[wall].load = load;
  plates_.set_load(wall, load);
}

template <int Dim>
void Simulation::EngineOf<Dim>::turn_wall(std::size_t wall, const Vec3& normal) {
  model_.walls[wall].normal = parts_.world.wall_specs[wall].normal = normal;
  parts_.world.wall_shapes[wall] =
      WallShape<Dim>(parts_.world.wall_specs[wall], parts_.world.grid.box());
  plates_.set_normal(wall, normal);
}

template <int Dim>
void Simulation::EngineOf<Dim>::set_wall_pose(std::size_t wall, const Vec3& point,
                                              const Vec3& normal) {
  Model wanted = model_;
  wanted.walls[wall].normal = normal;
  if (const auto fault = find_fault(wanted))
    throw InputError(kSetPose + fault->what, fault->remedy);
  WallState& state = parts_.world.walls[wall];
  agree(communicator_, [&] {
    if (state.is_active) check_free(parts_, wanted.walls[wall], point);
  });
  book_elastic([&] {
    if (normal != model_.walls[wall].normal) turn_wall(wall, normal);
    state.point = point;
    lists_.note_walls();  // it has not travelled there
    renew_lists();
  });
}

template <int Dim>
void Simulation::EngineOf<Dim>::book_elastic(const std::function<void()>& change) {
  begin_account();
  const bool accounts = parts_.world.accounts;
  const Measures before = accounts ? barchan::measure(parts_) : Measures();
  change();
  if (!accounts) return;
  const Measures after = barchan::measure(parts_);
  const auto more = [&](ExactSum Measures::*part) {
    return (after.*part).value() - (before.*part).value();
  };
  const double given = more(&Measures::elastic);
  if (!communicator_.is_root()) return;
  // As if the caller had pushed the particles there, against the contacts.
  EnergyWorks& works = parts_.strip.lane(0).brick.works;
  works[EnergyWorks::Callers].add(given);
  works[EnergyWorks::Contacts].add(-given);
  works[EnergyWorks::Sliding].add(more(&Measures::sliding_elastic));
  works[EnergyWorks::Rolling].add(more(&Measures::rolling_elastic));
}

template void Simulation::EngineOf<2>::set_wall_velocity(std::size_t, const Vec3&);
template void Simulation::EngineOf<2>::set_wall_load(std::size_t, double);
template void Simulation::EngineOf<2>::book_elastic(const std::function<void()>&);
template void Simulation::EngineOf<2>::turn_wall(std::size_t, const Vec3&);
template void Simulation::EngineOf<2>::set_wall_pose(std::size_t, const Vec3&, const Vec3&);
template void Simulation::EngineOf<3>::set_wall_velocity(std::size_t, const Vec3&);
template void Simulation::EngineOf<3>::set_wall_load(std::size_t, double);
template void Simulation::EngineOf<3>::book_elastic(const std::function<void()>&);
template void Simulation::EngineOf<3>::turn_wall(std::size_t, const Vec3&);
template void Simulation::EngineOf<3>::set_wall_pose(std::size_t, const Vec3&, const Vec3&);

}  // namespace barchan
