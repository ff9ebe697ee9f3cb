// Fields of the caller's own: what Simulation asks of callers, and what the engine does.
#include <algorithm>
#include <cstddef>
#include <span>
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

bool Simulation::add_field(const std::string& name, int components) {
  Engine& engine = between_steps("add_field");
  const std::uint64_t hash = hash_of(std::span<const char>(name));
  std::string fault =
      differing_lists(engine.communicator_, {hash, static_cast<std::uint64_t>(components)});
  if (!fault.empty())
    throw InputError("Simulation::add_field: ranks give different fields",
                     "give the same on every rank");
  fault = engine.fields_.fault_of(name, components);
  if (!fault.empty()) throw InputError("Simulation::add_field: " + fault, "");
  if (engine.fields_.find(name) != nullptr) return false;
  engine.add_field(name, components);
  return true;
}

const std::vector<CallerField>& Simulation::fields() const {
  return engine().fields_.all();
}

namespace {

const CallerField& field_of(const CallerFields& fields, const char* call, const std::string& name) {
  if (const CallerField* field = fields.find(name)) return *field;
  std::vector<std::string> names;
  for (const CallerField& known : fields.all()) names.push_back("'" + known.name + "'");
  throw std::invalid_argument(
      fmt::format("Simulation::{}: no field is called '{}': add_field() makes one, there are {}",
                  call, name, names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace

std::vector<FieldView> Simulation::field(const std::string& name) {
  Engine& engine = at_rest("field");
  return engine.field(field_of(engine.fields_, "field", name));
}

Gathered Simulation::gather(const std::string& name) {
  Engine& engine = between_steps("gather");
  return engine.gather(field_of(engine.fields_, "gather", name));
}

void Simulation::scatter(const std::string& name, std::span<const std::int64_t> ids,
                         std::span<const double> values) {
  Engine& engine = between_steps("scatter");
  const CallerField& field = field_of(engine.fields_, "scatter", name);
  std::string fault = differing_lists(engine.communicator_, {hash_of(ids), hash_of(values)});
  const auto components = static_cast<std::size_t>(field.components);
  if (fault.empty() && values.size() != components * ids.size())
    fault = fmt::format("{} numbers for {} particles: the field '{}' has {} components",
                        values.size(), ids.size(), name, components);
  if (const std::int64_t twin = twin_among(ids); fault.empty() && twin != 0)
    fault = fmt::format("particle {} is named twice", twin);
  if (!fault.empty()) throw InputError("Simulation::scatter: " + fault, "");
  engine.scatter(field, ids, values);
}

namespace {

template <int Dim>
StridedSpan<double> values_of(ParticleStore<Dim>& store, const CallerField& field) {
  return {store.carried.data() + field.at, static_cast<std::size_t>(store.num_owned),
          field.components, store.num_carried};
}

}  // namespace

template <int Dim>
void Simulation::EngineOf<Dim>::add_field(const std::string& name, int components) {
  fields_.add(name, components);
  parts_.world.num_carried = fields_.num_numbers();
  graph_.for_each_lane(
      [&](int l) { parts_.strip.lane(l).brick.store.set_num_carried(parts_.world.num_carried); });
  generation_.advance();
}

template <int Dim>
std::vector<FieldView> Simulation::EngineOf<Dim>::field(const CallerField& field) {
  std::vector<FieldView> views;
  for (Lane<Dim>& lane : parts_.strip.lanes())
    views.emplace_back(values_of(lane.brick.store, field), generation_);
  return views;
}

template <int Dim>
StridedSpan<double> Simulation::EngineOf<Dim>::field_of(int brick, const std::string& name) {
  return values_of(parts_.strip.lane(brick).brick.store, barchan::field_of(fields_, "field", name));
}

template <int Dim>
Gathered Simulation::EngineOf<Dim>::gather(const CallerField& field) {
  Gathered mine;
  for (Lane<Dim>& lane : parts_.strip.lanes()) {
    ParticleStore<Dim>& store = lane.brick.store;
    const auto n = static_cast<std::ptrdiff_t>(store.num_owned);
    mine.ids.insert(mine.ids.end(), store.id.begin(), store.id.begin() + n);
    const StridedSpan<double> values = values_of(store, field);
    for (std::size_t i = 0; i < values.size(); ++i)
      mine.values.insert(mine.values.end(), values[i], values[i] + field.components);
  }
  const auto ids = communicator_.gather_all(std::span<const std::int64_t>(mine.ids));
  const auto values = communicator_.gather_all(std::span<const double>(mine.values));
  Gathered all;
  for (const std::size_t k : order_of(ids)) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(k) * field.components;
    all.ids.push_back(ids[k]);
    all.values.insert(all.values.end(), from, from + field.components);
  }
  return all;
}

template <int Dim>
void Simulation::EngineOf<Dim>::scatter(const CallerField& field, std::span<const std::int64_t> ids,
                                        std::span<const double> values) {
  const std::vector<ParticlePlace> found = find_all(ids, "scatter");
  const auto components = static_cast<std::size_t>(field.components);
  for (std::size_t k = 0; k < ids.size(); ++k) {
    if (found[k].lane < 0) continue;
    ParticleStore<Dim>& store = parts_.strip.lane(found[k].lane).brick.store;
    std::copy_n(values.data() + components * k, components,
                values_of(store, field)[static_cast<std::size_t>(found[k].row)]);
  }
}

template void Simulation::EngineOf<2>::add_field(const std::string&, int);
template std::vector<FieldView> Simulation::EngineOf<2>::field(const CallerField&);
template StridedSpan<double> Simulation::EngineOf<2>::field_of(int, const std::string&);
template Gathered Simulation::EngineOf<2>::gather(const CallerField&);
template void Simulation::EngineOf<2>::scatter(const CallerField&, std::span<const std::int64_t>,
                                               std::span<const double>);
template void Simulation::EngineOf<3>::add_field(const std::string&, int);
template std::vector<FieldView> Simulation::EngineOf<3>::field(const CallerField&);
template StridedSpan<double> Simulation::EngineOf<3>::field_of(int, const std::string&);
template Gathered Simulation::EngineOf<3>::gather(const CallerField&);
template void Simulation::EngineOf<3>::scatter(const CallerField&, std::span<const std::int64_t>,
                                               std::span<const double>);

}  // namespace barchan
