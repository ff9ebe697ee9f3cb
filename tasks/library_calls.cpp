// What other solvers call between steps: arrays, loads, gravity, walls.
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <string>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/engine.hpp>

namespace barchan {
namespace {

template <int Dim>
constexpr int kTurns = Dim == 2 ? 1 : 3;
/// Where the c-th number of an angular velocity or torque is among three.
template <int Dim>
constexpr int place_of_turn(int c) {
  return Dim == 2 ? 2 : c;
}

/// Loads of all owned rows can be written.
template <int Dim>
void make_room(ParticleStore<Dim>& store) {
  constexpr std::size_t kForce = Layout<Dim>::kForce;
  store.external.resize(static_cast<std::size_t>(store.num_owned) * kForce, 0.0);
}

template <int Dim>
void put_load(ParticleStore<Dim>& store, std::int32_t row, const double* force,
              const double* torque) {
  double* to =
      store.external.data() + std::size_t{Layout<Dim>::kForce} * static_cast<std::size_t>(row);
  if (force != nullptr) std::copy_n(force, Dim, to);
  if (torque == nullptr) return;
  const double r = store.radius(row);
  for (int c = 0; c < kTurns<Dim>; ++c)
    to[Layout<Dim>::kTorque + c] = torque[place_of_turn<Dim>(c)] / r;
}

/// One record of a gather.
struct Row {
  std::int64_t id = 0;
  double values[3] = {};
};

template <int Dim>
Row row_of(const ParticleStore<Dim>& store, std::int32_t i, ParticleField field) {
  using F = ParticleField;
  Row row{store.id[static_cast<std::size_t>(i)], {}};
  const double* load =
      store.external.empty()
          ? nullptr
          : store.external.data() + std::size_t{Layout<Dim>::kForce} * static_cast<std::size_t>(i);
  const auto turn = [&](const double* from, double factor) {
    for (int c = 0; c < kTurns<Dim>; ++c) row.values[place_of_turn<Dim>(c)] = from[c] * factor;
  };
  switch (field) {
    case F::Position:
      std::copy_n(store.x(i), Dim, row.values);
      break;
    case F::Velocity:
      std::copy_n(store.v(i), Dim, row.values);
      break;
    case F::AngularVelocity:
      for (int c = 0; c < kTurns<Dim>; ++c)
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
      for (int c = 0; c < kTurns<Dim>; ++c)
        store.u(row)[c] = store.radius(row) * value[place_of_turn<Dim>(c)];
      break;
    case ParticleField::Force:
      put_load(store, row, value, nullptr);
      break;
    default:
      put_load(store, row, nullptr, value);
  }
}

}  // namespace

template <int Dim>
ParticleView Simulation::EngineOf<Dim>::view_of(Lane<Dim>& lane) {
  using L = Layout<Dim>;
  const ParticleStore<Dim>& s = lane.brick.store;
  const auto n = static_cast<std::size_t>(s.num_owned);
  const double* motion = s.motion.data();
  BrickArrays a;
  a.ids = {s.id.data(), n};
  a.positions = {motion, n, Dim, L::kMotion};
  a.velocities = {motion + L::kVelocity, n, Dim, L::kMotion};
  a.surface_speeds = Dim == 2 ? StridedSpan<const double>{motion + L::kSurface, n, 1, L::kMotion}
                              : StridedSpan<const double>{s.spin.data(), n, 3, 4};
  a.radii = {motion + L::kRadius, n, 1, L::kMotion};
  a.inverse_masses = {motion + L::kInverseMass, n, 1, L::kMotion};
  a.densities = {s.density.data(), n};
  a.types = {s.type.data(), n};
  return {a, generation_};
}

template <int Dim>
std::vector<ParticleView> Simulation::EngineOf<Dim>::owned() {
  std::vector<ParticleView> views;
  for (Lane<Dim>& lane : parts_.strip.lanes()) views.push_back(view_of(lane));
  return views;
}

template <int Dim>
std::vector<LoadView> Simulation::EngineOf<Dim>::loads() {
  using L = Layout<Dim>;
  std::vector<LoadView> views;
  for (Lane<Dim>& lane : parts_.strip.lanes()) {
    ParticleStore<Dim>& s = lane.brick.store;
    make_room(s);
    const auto n = static_cast<std::size_t>(s.num_owned);
    views.emplace_back(
        StridedSpan<double>(s.external.data(), n, Dim, L::kForce),
        StridedSpan<double>(s.external.data() + L::kTorque, n, kTurns<Dim>, L::kForce),
        StridedSpan<const double>(s.motion.data() + L::kRadius, n, 1, L::kMotion), generation_);
  }
  return views;
}

template <int Dim>
void Simulation::EngineOf<Dim>::for_each_view(
    const std::function<void(const ParticleView&)>& visit) {
  std::mutex guard;
  std::exception_ptr failure;
  graph_.for_each_lane([&](int l) {
    try {
      visit(view_of(parts_.strip.lane(l)));
    } catch (...) {
      const std::lock_guard<std::mutex> lock(guard);
      if (!failure) failure = std::current_exception();
    }
  });
  if (failure) std::rethrow_exception(failure);
}

template <int Dim>
const ParticleIndex& Simulation::EngineOf<Dim>::index() {
  if (index_.is_of(generation_.value())) return index_;
  std::vector<std::span<const std::int64_t>> ids;
  for (const Lane<Dim>& lane : parts_.strip.lanes())
    ids.emplace_back(lane.brick.store.id.data(),
                     static_cast<std::size_t>(lane.brick.store.num_owned));
  index_.make(generation_.value(), std::move(ids));
  return index_;
}

template <int Dim>
void Simulation::EngineOf<Dim>::set_loads(const Loads& loads) {
  const ParticleIndex& places = index();
  std::vector<ParticleRun> runs;
  for (std::size_t k = 0; k < loads.ids.size(); k += runs.back().length) {
    runs.push_back(places.find(loads.ids.subspan(k), runs.empty() ? ParticleRun{} : runs.back()));
    if (runs.back().first.lane < 0)  // nothing is set unless all are known
      throw std::invalid_argument(fmt::format(
          "Simulation::set_loads: particle {} is not on rank {}: name particles of this "
          "rank (owned()), or use scatter() on all ranks",
          loads.ids[k], communicator_.rank()));
  }
  for (Lane<Dim>& lane : parts_.strip.lanes()) make_room(lane.brick.store);
  const double *force = loads.forces.data(), *torque = loads.torques.data();
  for (const auto& [first, length] : runs) {
    constexpr double kNone[3] = {};
    ParticleStore<Dim>& store = parts_.strip.lane(first.lane).brick.store;
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(length); ++i, force += 3) {
      put_load(store, first.row + i, force, torque == nullptr ? kNone : torque);
      if (torque != nullptr) torque += 3;
    }
  }
}

template <int Dim>
Gathered Simulation::EngineOf<Dim>::gather(ParticleField field) {
  std::vector<Row> mine;
  mine.reserve(static_cast<std::size_t>(num_owned()));
  for (const Lane<Dim>& lane : parts_.strip.lanes()) {
    for (std::int32_t i = 0; i < lane.brick.store.num_owned; ++i)
      mine.push_back(row_of(lane.brick.store, i, field));
  }
  std::vector<Row> all = communicator_.gather_all(std::span<const Row>(mine));
  std::sort(all.begin(), all.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
  Gathered gathered;
  for (const Row& row : all) {
    gathered.ids.push_back(row.id);
    gathered.values.insert(gathered.values.end(), row.values, row.values + width_of(field));
  }
  return gathered;
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
  if (!is_motion) {
    for (Lane<Dim>& lane : parts_.strip.lanes()) make_room(lane.brick.store);
  }
  for (std::size_t k = 0; k < ids.size(); ++k) {
    if (found[k].lane >= 0)
      put_value(parts_.strip.lane(found[k].lane).brick.store, found[k].row, field,
                values.data() + 3 * k);
  }
  if (!is_motion) return;
  schedule_.amend(step_, 0, lists_.top_speed());
  renew_lists();  // ghosts get the new velocities, too
}

template <int Dim>
void Simulation::EngineOf<Dim>::set_gravity(const Vec3& gravity) {
  model_.gravity = gravity;
  if (!schedule_.raise_gravity(gravity.norm())) return;
  schedule_.amend(step_, 0, 0.0);
  renew_lists();
}

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

template class Simulation::EngineOf<2>;
template class Simulation::EngineOf<3>;

}  // namespace barchan
