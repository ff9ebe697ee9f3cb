// What other solvers call between steps: arrays, loads, gravity.
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <string>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/cut_shape.hpp>
#include <barchan/tasks/engine.hpp>
#include <barchan/tasks/load_rows.hpp>

namespace barchan {
namespace {

/// The arrays that views show, of one brick.
struct ReleasedArrays {
  AlignedVector<double> motion, spin, density, external, carried;
  AlignedVector<std::int64_t> id;
  AlignedVector<std::uint8_t> type;
};

}  // namespace

template <int Dim>
ParticleView Simulation::EngineOf<Dim>::view_of(int brick) {
  using L = Layout<Dim>;
  const ParticleStore<Dim>& s = parts_.strip.lane(brick).brick.store;
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
  return {a, generation_, *this, brick};
}

template <int Dim>
std::vector<ParticleView> Simulation::EngineOf<Dim>::owned() {
  std::vector<ParticleView> views;
  for (int b = 0; b < num_bricks(); ++b) views.push_back(view_of(b));
  return views;
}

template <int Dim>
LoadView Simulation::EngineOf<Dim>::loads_of(int brick) {
  using L = Layout<Dim>;
  ParticleStore<Dim>& s = parts_.strip.lane(brick).brick.store;
  make_room(s);
  const auto n = static_cast<std::size_t>(s.num_owned);
  return {{s.external.data(), n, Dim, L::kForce},
          {s.external.data() + L::kTorque, n, kSpins<Dim>, L::kForce},
          {s.motion.data() + L::kRadius, n, 1, L::kMotion},
          generation_};
}

template <int Dim>
std::vector<LoadView> Simulation::EngineOf<Dim>::loads() {
  std::vector<LoadView> views;
  for (int b = 0; b < num_bricks(); ++b) views.push_back(loads_of(b));
  return views;
}

template <int Dim>
std::shared_ptr<const void> Simulation::EngineOf<Dim>::release_arrays() {
  auto released = std::make_shared<std::vector<ReleasedArrays>>();
  for (Lane<Dim>& lane : parts_.strip.lanes()) {
    ParticleStore<Dim>& s = lane.brick.store;
    ReleasedArrays& old = released->emplace_back();
    const auto release = [](auto& array, auto& to) {
      to = std::move(array);
      array = to;
    };
    release(s.motion, old.motion);
    release(s.spin, old.spin);
    release(s.density, old.density);
    release(s.external, old.external);
    release(s.carried, old.carried);
    release(s.id, old.id);
    release(s.type, old.type);
  }
  generation_.advance();
  return released;
}

template <int Dim>
std::int64_t Simulation::EngineOf<Dim>::highest_id() {
  std::int64_t highest = 0;
  for (const Lane<Dim>& lane : parts_.strip.lanes()) {
    for (std::int32_t i = 0; i < lane.brick.store.num_owned; ++i)
      highest = std::max(highest, lane.brick.store.id[static_cast<std::size_t>(i)]);
  }
  communicator_.allreduce_max(std::span(&highest, 1));
  return highest;
}

template <int Dim>
void Simulation::EngineOf<Dim>::for_each_view(
    const std::function<void(const ParticleView&)>& visit) {
  std::mutex guard;
  std::exception_ptr failure;
  graph_.for_each_lane([&](int l) {
    try {
      visit(view_of(l));
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
  std::size_t at = 0;
  for (const auto& [first, length] : runs) {
    ParticleStore<Dim>& store = parts_.strip.lane(first.lane).brick.store;
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(length); ++i, at += 3) {
      const std::int32_t row = first.row + i;
      put_load(store, row, &loads.forces[at], loads.torques.empty() ? nullptr : &loads.torques[at]);
      if (loads.torques.empty()) clear_torque(store, row);
    }
  }
}

template <int Dim>
void Simulation::EngineOf<Dim>::set_gravity(const Vec3& gravity) {
  model_.gravity = gravity;
  if (!schedule_.raise_gravity(gravity.norm())) return;
  schedule_.amend(step_, 0, 0.0);
  renew_lists();
}

template <int Dim>
CutsInUse Simulation::EngineOf<Dim>::cuts() const {
  const CutShape& shape = parts_.lanes.shape();
  const CutRoom room = room_of(parts_.world.grid, 0);
  return {shape.form == CutForm::Strips, along_xyz(shape.ranks, room), along_xyz(shape.lanes, room),
          shape.depth};
}

template ParticleView Simulation::EngineOf<2>::view_of(int);
template LoadView Simulation::EngineOf<2>::loads_of(int);
template std::vector<ParticleView> Simulation::EngineOf<2>::owned();
template std::vector<LoadView> Simulation::EngineOf<2>::loads();
template std::shared_ptr<const void> Simulation::EngineOf<2>::release_arrays();
template std::int64_t Simulation::EngineOf<2>::highest_id();
template void Simulation::EngineOf<2>::for_each_view(
    const std::function<void(const ParticleView&)>&);
template const ParticleIndex& Simulation::EngineOf<2>::index();
template void Simulation::EngineOf<2>::set_loads(const Loads&);
template CutsInUse Simulation::EngineOf<2>::cuts() const;
template void Simulation::EngineOf<2>::set_gravity(const Vec3&);
template ParticleView Simulation::EngineOf<3>::view_of(int);
template LoadView Simulation::EngineOf<3>::loads_of(int);
template std::vector<ParticleView> Simulation::EngineOf<3>::owned();
template std::vector<LoadView> Simulation::EngineOf<3>::loads();
template std::shared_ptr<const void> Simulation::EngineOf<3>::release_arrays();
template std::int64_t Simulation::EngineOf<3>::highest_id();
template void Simulation::EngineOf<3>::for_each_view(
    const std::function<void(const ParticleView&)>&);
template const ParticleIndex& Simulation::EngineOf<3>::index();
template void Simulation::EngineOf<3>::set_loads(const Loads&);
template CutsInUse Simulation::EngineOf<3>::cuts() const;
template void Simulation::EngineOf<3>::set_gravity(const Vec3&);

}  // namespace barchan
