// What Simulation and WallControl ask of callers before the engine does what they want.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/model/digest.hpp>
#include <barchan/tasks/engine.hpp>

namespace barchan {
namespace {

bool are_finite(std::span<const double> values) {
  constexpr std::size_t kWidth = 8;  // chains of additions that do not wait for each other
  double sums[kWidth] = {};          // of zeros, or not a number
  std::size_t k = 0;
  for (; k + kWidth <= values.size(); k += kWidth)
    for (std::size_t c = 0; c < kWidth; ++c) sums[c] += 0.0 * values[k + c];
  for (; k < values.size(); ++k) sums[0] += 0.0 * values[k];
  return std::all_of(std::begin(sums), std::end(sums), [](double sum) { return sum == 0.0; });
}

/// Errors: InputError on every rank: ranks give different numbers, or some that are not finite.
void require_same(const Communicator& communicator, const char* call, const Vec3& values) {
  double both[6];
  for (int c = 0; c < 3; ++c) {
    both[c] = values[c];
    both[3 + c] = -values[c];
  }
  if (communicator.any_of(!are_finite(both)))
    throw InputError(fmt::format("Simulation::{}: a number is not finite", call), "");
  communicator.allreduce_max(std::span<double>(both));
  for (int c = 0; c < 3; ++c) {
    if (both[c] != -both[3 + c])
      throw InputError(fmt::format("Simulation::{}: ranks give different values", call),
                       "give the same on every rank");
  }
}

void require_plane(const Model& model, const char* call, const Vec3& v) {
  if (model.dimension == 2 && v[2] != 0.0)
    throw InputError(fmt::format("Simulation::{}: {} along z leaves the plane", call, v[2]),
                     "give 0 in 2D");
}

/// @return what is wrong, on every rank; empty: nothing
std::string differing_lists(const Communicator& communicator,
                            std::initializer_list<std::uint64_t> hashes) {
  bool differs = false;
  for (const std::uint64_t mine : hashes) {
    std::uint64_t first = mine;
    communicator.bcast(std::as_writable_bytes(std::span(&first, 1)));
    differs = differs || first != mine;
  }
  return communicator.any_of(differs) ? "ranks give different lists" : "";
}

template <class T>
std::uint64_t hash_of(std::span<const T> values) {
  return hash_of_bytes(std::as_bytes(values));
}

}  // namespace

std::int64_t Simulation::advance_to(double time) {
  const double dt = engine().model_.time.step;
  const double steps = std::round(time / dt) - static_cast<double>(engine().step_);
  if (!(steps >= 0.0 && steps < 9e15))
    throw std::invalid_argument(
        fmt::format("Simulation::advance_to: {} s, where the run is at {} s", time, this->time()));
  return run(static_cast<std::int64_t>(steps));
}

std::vector<ParticleView> Simulation::owned() {
  return between_steps("owned").owned();
}
int Simulation::num_bricks() const {
  return engine().num_bricks();
}
std::uint64_t Simulation::generation() const {
  return engine().generation_.value();
}
void Simulation::for_each_view(const std::function<void(const ParticleView&)>& visit) {
  between_steps("for_each_view").for_each_view(visit);
}
std::shared_ptr<const void> Simulation::release_arrays() {
  return engine().release_arrays();
}
std::int64_t Simulation::highest_id() {
  return between_steps("highest_id").highest_id();
}
std::vector<LoadView> Simulation::loads() {
  return between_steps("loads").loads();
}

void Simulation::set_loads(const Loads& loads) {
  Engine& engine = between_steps("set_loads");
  const auto require = [&](std::span<const double> numbers, const char* what) {
    if (numbers.size() != 3 * loads.ids.size())
      throw std::invalid_argument(
          fmt::format("Simulation::set_loads: {} numbers of {} for {} particles: three each",
                      numbers.size(), what, loads.ids.size()));
    if (!are_finite(numbers))
      throw std::invalid_argument(
          fmt::format("Simulation::set_loads: a number of {} is not finite", what));
  };
  require(loads.forces, "forces");
  if (!loads.torques.empty()) require(loads.torques, "torques");
  engine.set_loads(loads);
}

Gathered Simulation::gather(ParticleField field) {
  return between_steps("gather").gather(field);
}

void Simulation::scatter(ParticleField field, std::span<const std::int64_t> ids,
                         std::span<const double> values) {
  Engine& engine = between_steps("scatter");
  std::string fault = differing_lists(engine.communicator_, {hash_of(ids), hash_of(values)});
  if (fault.empty() && values.size() != 3 * ids.size())
    fault = fmt::format("{} numbers for {} particles: three each", values.size(), ids.size());
  if (fault.empty() && !are_finite(values)) fault = "a number is not finite";
  using F = ParticleField;
  if (field != F::Velocity && field != F::AngularVelocity && field != F::Force &&
      field != F::Torque)
    fault = "this field is not to be set: velocity, angular velocity, force and torque are";
  if (!fault.empty()) throw InputError("Simulation::scatter: " + fault, "");
  engine.scatter(field, ids, values);
}

void Simulation::add(std::span<const ParticleData> newcomers) {
  Engine& engine = between_steps("add");
  const ParticleSet set{{newcomers.begin(), newcomers.end()}, {}};
  const std::string fault = differing_lists(engine.communicator_, {particle_set_hash(set)});
  if (!fault.empty()) throw InputError("Simulation::add: " + fault, "");
  if (!newcomers.empty()) engine.add(set);
}

void Simulation::remove(std::span<const std::int64_t> ids) {
  Engine& engine = between_steps("remove");
  std::string fault = differing_lists(engine.communicator_, {hash_of(ids)});
  std::vector<std::int64_t> sorted(ids.begin(), ids.end());
  std::sort(sorted.begin(), sorted.end());
  const auto twin = std::adjacent_find(sorted.begin(), sorted.end());
  if (fault.empty() && twin != sorted.end())
    fault = fmt::format("particle {} is named twice", *twin);
  if (!fault.empty()) throw InputError("Simulation::remove: " + fault, "");
  if (!ids.empty()) engine.remove(sorted);
}

void Simulation::set_gravity(const Vec3& gravity) {
  Engine& engine = between_steps("set_gravity");
  require_same(engine.communicator_, "set_gravity", gravity);
  require_plane(engine.model_, "set_gravity", gravity);
  engine.set_gravity(gravity);
}

WallControl Simulation::wall(const std::string& name) {
  const std::vector<WallSpec>& walls = engine().model_.walls;
  std::vector<std::string> names;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (walls[w].name == name) return {*this, w};
    names.push_back("'" + walls[w].name + "'");
  }
  throw std::invalid_argument(
      fmt::format("Simulation::wall: no wall is called '{}': there are {}", name,
                  names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

const WallState& WallControl::state() const {
  return simulation_->walls()[wall_];
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

State Simulation::save() {
  State state;
  save(state);
  return state;
}

void Simulation::save(State& state) {
  between_steps("save").save(state.data_);
}

void Simulation::load(const State& state) {
  Engine& engine = between_steps("load");
  if (state.is_empty())
    throw std::logic_error("Simulation::load: the state is empty: save to it first");
  if (!state.data_->owner.is_of(engine.generation_))
    throw std::logic_error("Simulation::load: the state is of another simulation");
  engine.load(*state.data_);
}

}  // namespace barchan
