// What Simulation asks of callers before the engine does what they want.
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
#include <barchan/tasks/caller_checks.hpp>
#include <barchan/tasks/engine.hpp>
#include <barchan/tasks/id_order.hpp>

namespace barchan {

std::int64_t Simulation::advance_to(double time) {
  require_same(between_steps("advance_to").communicator_, "advance_to", Vec3(time, 0.0, 0.0));
  constexpr double kSame = 1e-6;  // share of a step
  const double dt = engine().model_.time.step;
  const double steps = (time - this->time()) / dt, whole = std::floor(steps + kSame);
  if (!(whole >= 0.0 && whole < 9e15))
    throw std::invalid_argument(
        fmt::format("Simulation::advance_to: {} s, where the run is at {} s", time, this->time()));
  const std::int64_t done = run(static_cast<std::int64_t>(whole));
  if (done < static_cast<std::int64_t>(whole) || steps - whole <= kSame) return done;
  return done + between_steps("advance_to").run_short(time);
}

void Simulation::set_time_step(double dt) {
  Engine& engine = between_steps("set_time_step");
  require_same(engine.communicator_, "set_time_step", Vec3(dt, 0.0, 0.0));
  if (!(dt > 0.0))
    throw InputError(fmt::format("Simulation::set_time_step: {} s", dt), "give a time above zero");
  if (dt != engine.model_.time.step) engine.set_time_step(dt);
}

std::vector<LinkForce> Simulation::links(LinkKind kind) {
  return between_steps("links").links(kind);
}

std::vector<ParticleView> Simulation::owned() {
  return at_rest("owned").owned();
}
int Simulation::num_bricks() const {
  return engine().num_bricks();
}
std::uint64_t Simulation::generation() const {
  return engine().generation_.value();
}
void Simulation::for_each_view(const std::function<void(const ParticleView&)>& visit) {
  at_rest("for_each_view").for_each_view(visit);
}
std::shared_ptr<const void> Simulation::release_arrays() {
  return engine().release_arrays();
}
std::int64_t Simulation::highest_id() {
  return between_steps("highest_id").highest_id();
}
std::vector<LoadView> Simulation::loads() {
  return at_rest("loads").loads();
}

void Simulation::set_loads(const Loads& loads) {
  Engine& engine = at_rest("set_loads");
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

namespace {

/// Empty: there are temperatures, or another field is meant.
std::string lack_of_heat(const Model& model, ParticleField field) {
  if (field != ParticleField::Temperature || model.heat.is_on) return {};
  return "particles have no temperatures: the model has no heat";
}

}  // namespace

Gathered Simulation::gather(ParticleField field) {
  Engine& engine = between_steps("gather");
  const std::string fault = lack_of_heat(model(), field);
  if (!fault.empty()) throw InputError("Simulation::gather: " + fault, "add [heat] to the deck");
  return engine.gather(field);
}

void Simulation::scatter(ParticleField field, std::span<const std::int64_t> ids,
                         std::span<const double> values) {
  Engine& engine = between_steps("scatter");
  std::string fault = differing_lists(engine.communicator_, {hash_of(ids), hash_of(values)});
  const auto width = static_cast<std::size_t>(width_of(field));
  if (fault.empty() && values.size() != width * ids.size() && width == 3)
    fault = fmt::format("{} numbers for {} particles: three each", values.size(), ids.size());
  if (fault.empty() && !are_finite(values)) fault = "a number is not finite";
  if (const std::int64_t twin = twin_among(ids); fault.empty() && twin != 0)
    fault = fmt::format("particle {} is named twice", twin);
  using F = ParticleField;
  if (field != F::Velocity && field != F::AngularVelocity && field != F::Force &&
      field != F::Torque && field != F::Temperature)
    fault =
        "this field is not to be set: velocity, angular velocity, force, torque and temperature "
        "are";
  if (fault.empty() && values.size() != width * ids.size())
    fault = fmt::format("{} numbers for {} particles: one each", values.size(), ids.size());
  if (fault.empty()) fault = lack_of_heat(model(), field);
  const auto is_cold = [](double t) { return t < 0.0; };
  if (fault.empty() && field == F::Temperature && std::ranges::any_of(values, is_cold))
    fault = "a temperature is below 0 K";
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
  if (const std::int64_t twin = twin_among(ids); fault.empty() && twin != 0)
    fault = fmt::format("particle {} is named twice", twin);
  if (!fault.empty()) throw InputError("Simulation::remove: " + fault, "");
  std::vector<std::int64_t> sorted(ids.begin(), ids.end());
  std::sort(sorted.begin(), sorted.end());
  if (!ids.empty()) engine.remove(sorted);
}

void Simulation::set_gravity(const Vec3& gravity) {
  Engine& engine = between_steps("set_gravity");
  require_same(engine.communicator_, "set_gravity", gravity);
  require_plane(engine.model_, "set_gravity", gravity);
  engine.set_gravity(gravity);
}

namespace {

int material_of(const Model& model, const char* call, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    if (model.materials[m].name == name) return static_cast<int>(m);
    names.push_back("'" + model.materials[m].name + "'");
  }
  throw std::invalid_argument(
      fmt::format("Simulation::{}: no material is called '{}': there are {}", call, name,
                  fmt::join(names, ", ")));
}

}  // namespace

const ContactConstants& Simulation::contact(const std::string& a, const std::string& b) const {
  const Model& m = model();
  return m.contacts.at(material_of(m, "contact", a), material_of(m, "contact", b));
}

void Simulation::set_contact(const std::string& a, const std::string& b,
                             const ContactConstants& constants) {
  Engine& engine = between_steps("set_contact");
  const Model& model = engine.model_;
  const auto first = static_cast<std::size_t>(material_of(model, "set_contact", a)),
             second = static_cast<std::size_t>(material_of(model, "set_contact", b));
  ContactTable table = model.contacts;
  const auto n = static_cast<std::size_t>(table.num_materials);
  table.constants[first * n + second] = table.constants[second * n + first] = constants;
  std::vector<double> numbers{static_cast<double>(std::min(first, second)),
                              static_cast<double>(std::max(first, second))};
  with_law(table.law, [&]<class Law>(Law /*law*/) {
    Law::for_each_number(constants, [&](const char*, double value) { numbers.push_back(value); });
  });
  const auto hash = hash_of(std::span<const double>(numbers));
  if (!differing_lists(engine.communicator_, {hash}).empty())
    throw InputError("Simulation::set_contact: ranks give different values",
                     "give the same on every rank");
  engine.set_contacts(table);
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
