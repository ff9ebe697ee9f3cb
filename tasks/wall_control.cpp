#include <barchan/tasks/wall_control.hpp>

#include <cmath>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/tasks/caller_checks.hpp>
#include <barchan/tasks/engine.hpp>

namespace barchan {

const WallState& WallControl::state() const {
  return simulation_->walls()[wall_];
}

const Vec3& WallControl::normal() const {
  return simulation_->model().walls[wall_].normal;
}

void WallControl::set_velocity(const Vec3& velocity) {
  constexpr const char* kCall = "wall().set_velocity";
  Simulation::Engine& engine = simulation_->between_steps(kCall);
  const WallSpec& spec = engine.model_.walls[wall_];
  if (spec.is_loaded)
    throw InputError(
        fmt::format("Simulation::{}: wall '{}' is moved by its load", kCall, spec.name),
        "use set_load");
  require_same(engine.communicator_, kCall, velocity);
  require_plane(engine.model_, kCall, velocity);
  engine.set_wall_velocity(wall_, velocity);
}

void WallControl::set_load(double load) {
  constexpr const char* kCall = "wall().set_load";
  Simulation::Engine& engine = simulation_->between_steps(kCall);
  const WallSpec& spec = engine.model_.walls[wall_];
  if (!spec.is_loaded)
    throw InputError(fmt::format("Simulation::{}: wall '{}' is not loaded", kCall, spec.name),
                     "give it a load and a mass in the model, or use set_velocity");
  require_same(engine.communicator_, kCall, Vec3(load, 0.0, 0.0));
  engine.set_wall_load(wall_, load);
}

void WallControl::set_pose(const Vec3& point) {
  set_pose(point, normal());
}

void WallControl::set_pose(const Vec3& point, const Vec3& normal) {
  constexpr const char* kCall = "wall().set_pose";
  Simulation::Engine& engine = simulation_->between_steps(kCall);
  for (const Vec3* v : {&point, &normal}) {
    require_same(engine.communicator_, kCall, *v);
    require_plane(engine.model_, kCall, *v);
  }
  const double length = normal.norm();
  if (!(length > 0.0))
    throw InputError(fmt::format("Simulation::{}: the normal has no length", kCall), "give one");
  const bool is_unit = std::fabs(length - 1.0) <= 1e-12;  // such as the one that it has
  engine.set_wall_pose(wall_, point, is_unit ? normal : Vec3(normal / length));
}

}  // namespace barchan
