// Fields of all particles, there and back: gather and scatter.
#include <algorithm>
#include <limits>
#include <string>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/engine.hpp>
#include <barchan/tasks/id_order.hpp>
#include <barchan/tasks/load_rows.hpp>

namespace barchan {
namespace {

/// One record of a gather.
struct Row {
  std::int64_t id = 0;
  double values[3] = {};
};

/// Force and torque / radius by the caller; null: none has one.
template <int Dim>
const double* load_on(const ParticleStore<Dim>& store, std::int32_t i) {
  if (store.external.empty()) return nullptr;
  return store.external.data() + std::size_t{Layout<Dim>::kForce} * static_cast<std::size_t>(i);
}

template <int Dim>
Row row_of(const ParticleStore<Dim>& store, std::int32_t i, ParticleField field) {
  using F = ParticleField;
  Row row{store.id[static_cast<std::size_t>(i)], {}};
  const double* load = load_on(store, i);
  const auto turn = [&](const double* from, double factor) {
    for (int c = 0; c < kSpins<Dim>; ++c) row.values[place_of_turn<Dim>(c)] = from[c] * factor;
  };
  switch (field) {
    case F::Position:
      std::copy_n(store.x(i), Dim, row.values);
      break;
    case F::Velocity:
      std::copy_n(store.v(i), Dim, row.values);
      break;
    case F::AngularVelocity:
      for (int c = 0; c < kSpins<Dim>; ++c)
        row.values[place_of_turn<Dim>(c)] = store.u(i)[c] / store.radius(i);
      break;
    case F::Force:
      if (load != nullptr) std::copy_n(load, Dim, row.values);
      break;
    case F::Torque:
      if (load != nullptr) turn(load + Layout<Dim>::kTorque, store.radius(i));
      break;
    case F::Radius:
      row.values[0] = store.radius(i);
      break;
    case F::Mass: {
      const double im = store.inverse_mass(i);
      row.values[0] = im > 0.0 ? 1.0 / im : std::numeric_limits<double>::infinity();
      break;
    }
    case F::Type:
      row.values[0] = store.type[static_cast<std::size_t>(i)];
      break;
    case F::Temperature:
      row.values[0] = *store.t(i);
      break;
  }
  return row;
}

template <int Dim>
void put_value(ParticleStore<Dim>& store, std::int32_t row, ParticleField field,
               const double* value) {
  switch (field) {
    case ParticleField::Velocity:
      std::copy_n(value, Dim, store.v(row));
      break;
    case ParticleField::AngularVelocity:
      for (int c = 0; c < kSpins<Dim>; ++c)
        store.u(row)[c] = store.radius(row) * value[place_of_turn<Dim>(c)];
      break;
    case ParticleField::Force:
      put_load(store, row, value, nullptr);
      break;
    case ParticleField::Temperature:
      store.t(row)[0] = *value, store.t(row)[1] = 0.0;
      break;
    default:
      put_load(store, row, nullptr, value);
  }
}

}  // namespace

template <int Dim>
Gathered Simulation::EngineOf<Dim>::gather(ParticleField field) {
  std::vector<Row> mine;
  mine.reserve(static_cast<std::size_t>(num_owned()));
  for (const Lane<Dim>& lane : parts_.strip.lanes()) {
    for (std::int32_t i = 0; i < lane.brick.store.num_owned; ++i)
      mine.push_back(row_of(lane.brick.store, i, field));
  }
  const std::vector<Row> all = communicator_.gather_all(std::span<const Row>(mine));
  std::vector<std::int64_t> ids(all.size());
  std::transform(all.begin(), all.end(), ids.begin(), [](const Row& row) { return row.id; });
  const auto width = static_cast<std::size_t>(width_of(field));
  Gathered gathered{{}, std::vector<double>(width * all.size())};
  gathered.ids.reserve(all.size());
  double* to = gathered.values.data();
  for (const std::size_t k : order_of(ids)) {
    gathered.ids.push_back(ids[k]);
    to = std::copy_n(all[k].values, width, to);
  }
  return gathered;
}

template <int Dim>
void Simulation::EngineOf<Dim>::book_kinetic(std::span<const ParticlePlace> places, double share) {
  if (!parts_.world.accounts) return;
  for (const ParticlePlace& at : places) {
    if (at.lane < 0) continue;
    Brick<Dim>& brick = parts_.strip.lane(at.lane).brick;
    brick.works[EnergyWorks::Callers].add(share * kinetic_energy(brick.store, at.row));
  }
}

template <int Dim>
void Simulation::EngineOf<Dim>::scatter(ParticleField field, std::span<const std::int64_t> ids,
                                        std::span<const double> values) {
  const bool is_motion =
      field == ParticleField::Velocity || field == ParticleField::AngularVelocity;
  const std::vector<ParticlePlace> found = find_all(ids, "scatter");
  agree(communicator_, [&] {
    for (std::size_t k = 0; k < ids.size() && is_motion; ++k) {
      const ParticlePlace at = found[k];
      if (at.lane >= 0 && parts_.strip.lane(at.lane).brick.store.inverse_mass(at.row) == 0.0)
        throw InputError(fmt::format("Simulation::scatter: particle {} is fixed", ids[k]),
                         "leave it out");
    }
  });
  if (is_motion) {
    begin_account();
    book_kinetic(found, -1.0);
  } else if (field != ParticleField::Temperature) {
    for (Lane<Dim>& lane : parts_.strip.lanes()) make_room(lane.brick.store);
  }
  for (std::size_t k = 0; k < ids.size(); ++k) {
    if (found[k].lane >= 0)
      put_value(parts_.strip.lane(found[k].lane).brick.store, found[k].row, field,
                values.data() + static_cast<std::size_t>(width_of(field)) * k);
  }
  if (is_motion) {
    book_kinetic(found, 1.0);
    schedule_.amend(step_, 0, lists_.top_speed());
  }
  // Ghosts get the new velocities and temperatures, too.
  if (is_motion || field == ParticleField::Temperature) renew_lists();
}

template Gathered Simulation::EngineOf<2>::gather(ParticleField);
template void Simulation::EngineOf<2>::book_kinetic(std::span<const ParticlePlace>, double);
template void Simulation::EngineOf<2>::scatter(ParticleField, std::span<const std::int64_t>,
                                               std::span<const double>);
template Gathered Simulation::EngineOf<3>::gather(ParticleField);
template void Simulation::EngineOf<3>::book_kinetic(std::span<const ParticlePlace>, double);
template void Simulation::EngineOf<3>::scatter(ParticleField, std::span<const std::int64_t>,
                                               std::span<const double>);

}  // namespace barchan
