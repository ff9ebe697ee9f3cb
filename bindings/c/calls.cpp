// Runs, measures and arrays of barchan.h.
#include <algorithm>
#include <array>
#include <vector>

#include "arrays.hpp"

namespace {

using barchan::ParticleView;
using barchan::Simulation;
using barchan::StridedSpan;
using barchan::c::brick_of;
using barchan::c::kNowhere;
using barchan::c::require;
using barchan::c::with;

/// Errors: std::invalid_argument
StridedSpan<const double> span_of(const ParticleView& view, int field) {
  switch (field) {
    case BARCHAN_POSITION:
      return view.positions();
    case BARCHAN_VELOCITY:
      return view.velocities();
    case BARCHAN_RADIUS:
      return view.radii();
    case BARCHAN_SURFACE_SPEED:
      return view.surface_speeds();
    case BARCHAN_INVERSE_MASS:
      return view.inverse_masses();
    case BARCHAN_DENSITY:
      return {view.densities().data(), view.size(), 1, 1};
    default:
      throw std::invalid_argument("this field is no array");
  }
}

void put(const barchan::Vec3& from, double* to) {
  for (int c = 0; c < 3; ++c) to[c] = from[c];
}

}  // namespace

void barchan::c::give(const ParticleView& from, int field, barchan_view* to) {
  require(to != nullptr, kNowhere);
  const auto span = span_of(from, field);
  *to = {span.data(), static_cast<int64_t>(span.size()), span.stride(), span.width()};
}

extern "C" {

int barchan_run(barchan_sim* sim, int64_t steps, int64_t* done) {
  return with(sim, [&](Simulation& s) {
    const std::int64_t n = s.run(steps);
    if (done != nullptr) *done = n;
  });
}

int barchan_advance_to(barchan_sim* sim, double time, int64_t* done) {
  return with(sim, [&](Simulation& s) {
    const std::int64_t n = s.advance_to(time);
    if (done != nullptr) *done = n;
  });
}

int barchan_set_time_step(barchan_sim* sim, double step) {
  return with(sim, [&](Simulation& s) { s.set_time_step(step); });
}

int barchan_write_checkpoint(barchan_sim* sim, const char* folder) {
  return with(sim, [&](Simulation& s) {
    require(folder != nullptr, "barchan_write_checkpoint: the folder is NULL");
    s.keep_checkpoints(folder, s.model().checkpoint);
    s.save_checkpoint();
    if (!s.finish_checkpoints())
      throw barchan::CommonError(std::string("the checkpoint could not be written to ") + folder);
  });
}

int barchan_keep_checkpoints(barchan_sim* sim, const char* folder, int64_t every_steps,
                             double every_seconds, int keep) {
  return with(sim, [&](Simulation& s) {
    require(folder != nullptr, "barchan_keep_checkpoints: the folder is NULL");
    s.keep_checkpoints(folder, {every_steps, every_seconds, keep});
  });
}

int barchan_get_info(barchan_sim* sim, barchan_info* info) {
  return with(sim, [&](Simulation& s) {
    require(info != nullptr, kNowhere);
    info->time = s.time();
    info->step_length = s.model().time.step;
    info->step = s.step();
    info->num_particles = s.num_particles();
    info->num_owned = s.num_owned();
    info->generation = s.generation();
    info->dimension = s.model().dimension;
    info->num_bricks = static_cast<int32_t>(s.num_bricks());
    info->num_walls = static_cast<int32_t>(s.walls().size());
    info->stage = s.stage();
    info->stopped = s.stopped() ? 1 : 0;
  });
}

int barchan_measure(barchan_sim* sim, barchan_measures* measures) {
  return with(sim, [&](Simulation& s) {
    const barchan::Measures m = s.measure();
    if (measures == nullptr) return;
    measures->kinetic = m.kinetic.value();
    measures->elastic = m.elastic.value();
    measures->gravitational = m.gravitational.value();
    for (int c = 0; c < 3; ++c) measures->momentum[c] = m.momentum[c].value();
    measures->max_overlap = m.max_overlap;
    measures->max_speed = m.max_speed;
    measures->contacts = m.contacts;
    measures->bonds = m.bonds;
    measures->broken_bonds = m.broken_bonds;
  });
}

int barchan_digest(barchan_sim* sim, uint64_t* digest) {
  return with(sim, [&](Simulation& s) {
    const std::uint64_t d = s.digest();
    if (digest != nullptr) *digest = d;
  });
}

int barchan_get_view(barchan_sim* sim, int brick, int field, barchan_view* view) {
  return with(sim,
              [&](Simulation& s) { barchan::c::give(brick_of(s.owned(), brick), field, view); });
}

int barchan_get_ids(barchan_sim* sim, int brick, const int64_t** ids, int64_t* size) {
  return with(
      sim, [&](Simulation& s) { barchan::c::give(brick_of(s.owned(), brick).ids(), ids, size); });
}

int barchan_get_types(barchan_sim* sim, int brick, const uint8_t** types, int64_t* size) {
  return with(sim, [&](Simulation& s) {
    barchan::c::give(brick_of(s.owned(), brick).types(), types, size);
  });
}

int barchan_get_loads(barchan_sim* sim, int brick, barchan_loads* loads) {
  return with(sim,
              [&](Simulation& s) { barchan::c::give(brick_of(s.owned(), brick).loads(), loads); });
}

int barchan_get_links(barchan_sim* sim, int kind, int64_t room, barchan_link* links,
                      int64_t* count) {
  return with(sim, [&](Simulation& s) {
    require(kind >= BARCHAN_CONTACT && kind <= BARCHAN_BOND,
            "barchan_get_links: there is no such kind of links");
    const auto all = s.links(static_cast<barchan::LinkKind>(kind));
    const auto n = static_cast<int64_t>(all.size());
    if (count != nullptr) *count = n;
    if (links == nullptr) return;
    require(room >= n, "barchan_get_links: there is no room for all links");
    for (const barchan::LinkForce& from : all) {
      barchan_link& to = *links++;
      to.first = from.first;
      to.second = from.second;
      to.overlap = from.overlap;
      to.normal_force = from.normal_force;
      put(from.normal, to.normal);
      put(from.tangential_force, to.tangential_force);
    }
  });
}

int barchan_get_wall(barchan_sim* sim, const char* wall, barchan_wall* state) {
  return with(sim, [&](Simulation& s) {
    require(wall != nullptr && state != nullptr, kNowhere);
    const barchan::WallState& w = s.wall(wall).state();
    put(w.point, state->point);
    put(w.velocity, state->velocity);
    put(w.force, state->force);
    put(w.torque, state->torque);
    state->work = w.work;
    state->is_active = w.is_active ? 1 : 0;
  });
}

int barchan_get_wall_normal(barchan_sim* sim, const char* wall, double normal[3]) {
  return with(sim, [&](Simulation& s) {
    require(wall != nullptr && normal != nullptr, kNowhere);
    put(s.wall(wall).normal(), normal);
  });
}

}  // extern "C"
