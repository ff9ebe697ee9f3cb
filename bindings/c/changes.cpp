// What callers change, by barchan.h: loads, fields by id, particles, walls, states.
#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include <barchan/core/deck/overrides.hpp>
#include <barchan/core/model/contact_numbers.hpp>

#include "arrays.hpp"

namespace {

using barchan::Simulation;
using barchan::Vec3;
using barchan::c::list_of;
using barchan::c::require;
using barchan::c::with;

barchan::ParticleField field_of(int field) {
  using F = barchan::ParticleField;
  constexpr std::array kFields{F::Position, F::Velocity, F::AngularVelocity,
                               F::Force,    F::Torque,   F::Radius,
                               F::Mass,     F::Type};
  if (field == BARCHAN_TEMPERATURE) return F::Temperature;
  require(field >= 0 && static_cast<std::size_t>(field) < kFields.size(),
          "this field is not to be gathered or scattered");
  return kFields[static_cast<std::size_t>(field)];
}

Vec3 vector_of(const double* v) {
  require(v != nullptr, "a vector is NULL");
  return {v[0], v[1], v[2]};
}

barchan::ParticleData particle_of(const barchan_particle& from) {
  barchan::ParticleData p;
  p.id = from.id;
  p.type = from.type;
  p.fixed = from.fixed != 0;
  p.radius = from.radius;
  p.density = from.density;
  p.position = vector_of(from.position);
  p.velocity = vector_of(from.velocity);
  p.omega = vector_of(from.omega);
  return p;
}

}  // namespace

extern "C" {

int barchan_set_loads(barchan_sim* sim, int64_t count, const int64_t* ids, const double* forces,
                      const double* torques) {
  return with(sim, [&](Simulation& s) {
    barchan::Loads loads{list_of(ids, count, "barchan_set_loads: ids are NULL"),
                         list_of(forces, 3 * count, "barchan_set_loads: forces are NULL"),
                         {}};
    if (torques != nullptr) loads.torques = list_of(torques, 3 * count, "");
    s.set_loads(loads);
  });
}

int barchan_clear_loads(barchan_sim* sim) {
  return with(sim, [](Simulation& s) { s.clear_forces(); });
}

int barchan_gather(barchan_sim* sim, int field, int64_t room, int64_t* ids, double* values,
                   int64_t* count) {
  return with(sim, [&](Simulation& s) {
    barchan::c::give(s, s.gather(field_of(field)), {room, ids, values, count});
  });
}

int barchan_scatter(barchan_sim* sim, int field, int64_t count, const int64_t* ids,
                    const double* values) {
  return with(sim, [&](Simulation& s) {
    const int width = width_of(field_of(field));
    s.scatter(field_of(field), list_of(ids, count, "barchan_scatter: ids are NULL"),
              list_of(values, width * count, "barchan_scatter: values are NULL"));
  });
}

int barchan_add(barchan_sim* sim, int64_t count, const barchan_particle* particles) {
  return with(sim, [&](Simulation& s) {
    std::vector<barchan::ParticleData> newcomers;
    for (const barchan_particle& p :
         list_of(particles, count, "barchan_add: the particles are NULL"))
      newcomers.push_back(particle_of(p));
    s.add(newcomers);
  });
}

int barchan_remove(barchan_sim* sim, int64_t count, const int64_t* ids) {
  return with(
      sim, [&](Simulation& s) { s.remove(list_of(ids, count, "barchan_remove: ids are NULL")); });
}

int barchan_set_gravity(barchan_sim* sim, const double gravity[3]) {
  return with(sim, [&](Simulation& s) { s.set_gravity(vector_of(gravity)); });
}

int barchan_set_contact(barchan_sim* sim, const char* a, const char* b, const char* numbers) {
  return with(sim, [&](Simulation& s) {
    require(a != nullptr && b != nullptr && numbers != nullptr,
            "barchan_set_contact: a material or the numbers are NULL");
    barchan::ContactConstants pair = s.contact(a, b);
    std::istringstream lines(numbers);
    for (std::string line; std::getline(lines, line);) {
      if (line.empty()) continue;
      const barchan::DeckOverride number = barchan::parse_override(line);
      const char* const end = number.value.data() + number.value.size();
      double value = 0.0;
      const auto read = std::from_chars(number.value.data(), end, value);
      require(read.ec == std::errc() && read.ptr == end,
              "barchan_set_contact: a value is no number");
      barchan::set_number(s.model().contacts, pair, number.key, value);
    }
    s.set_contact(a, b, pair);
  });
}

int barchan_set_wall_velocity(barchan_sim* sim, const char* wall, const double velocity[3]) {
  return with(sim, [&](Simulation& s) {
    require(wall != nullptr, "barchan_set_wall_velocity: the wall's name is NULL");
    s.wall(wall).set_velocity(vector_of(velocity));
  });
}

int barchan_set_wall_load(barchan_sim* sim, const char* wall, double load) {
  return with(sim, [&](Simulation& s) {
    require(wall != nullptr, "barchan_set_wall_load: the wall's name is NULL");
    s.wall(wall).set_load(load);
  });
}

int barchan_set_wall_pose(barchan_sim* sim, const char* wall, const double point[3],
                          const double normal[3]) {
  return with(sim, [&](Simulation& s) {
    require(wall != nullptr, "barchan_set_wall_pose: the wall's name is NULL");
    if (normal == nullptr)
      s.wall(wall).set_pose(vector_of(point));
    else
      s.wall(wall).set_pose(vector_of(point), vector_of(normal));
  });
}

int barchan_save(barchan_sim* sim, barchan_state** state) {
  return with(sim, [&](Simulation& s) {
    require(state != nullptr, "barchan_save: nowhere to put the state");
    require(*state == nullptr || barchan::c::is_known(*state),
            "barchan_save: there is no such state: begin with NULL");
    if (*state != nullptr) return s.save((*state)->state);
    auto made = std::make_unique<barchan_state>();
    s.save(made->state);
    barchan::c::note(made.get());
    *state = made.release();
  });
}

int barchan_load(barchan_sim* sim, const barchan_state* state) {
  return with(sim, [&](Simulation& s) {
    require(state != nullptr && barchan::c::is_known(state),
            "barchan_load: there is no such state: barchan_save makes one");
    s.load(state->state);
  });
}

int barchan_free_state(barchan_state* state) {
  if (state == nullptr) return BARCHAN_OK;
  if (!barchan::c::is_known(state))
    return barchan::c::fail(BARCHAN_WRONG_CALL, "there is no such state: it was freed before");
  barchan::c::forget(state);
  delete state;
  return BARCHAN_OK;
}

}  // extern "C"
