// Runs, measures and arrays of barchan.h.
#include <algorithm>
#include <array>
#include <vector>

#include "handle.hpp"

namespace {

using barchan::ParticleView;
using barchan::Simulation;
using barchan::StridedSpan;
using barchan::c::require;
using barchan::c::with;

constexpr const char* kNowhere = "a pointer to the result is NULL";

template <class View>
const View& brick_of(const std::vector<View>& views, int brick) {
  require(brick >= 0 && static_cast<std::size_t>(brick) < views.size(),
          "there is no such brick: they count from 0 to num_bricks - 1");
  return views[static_cast<std::size_t>(brick)];
}

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
      throw std::invalid_argument("barchan_get_view: this field is no array");
  }
}

void put(const barchan::Vec3& from, double* to) {
  for (int c = 0; c < 3; ++c) to[c] = from[c];
}

}  // namespace

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
  return with(sim, [&](Simulation& s) {
    require(view != nullptr, kNowhere);
    const auto span = span_of(brick_of(s.owned(), brick), field);
    *view = {span.data(), static_cast<int64_t>(span.size()), span.stride(), span.width()};
  });
}

int barchan_get_ids(barchan_sim* sim, int brick, const int64_t** ids, int64_t* size) {
  return with(sim, [&](Simulation& s) {
    require(ids != nullptr && size != nullptr, kNowhere);
    const auto span = brick_of(s.owned(), brick).ids();
    *ids = span.data();
    *size = static_cast<int64_t>(span.size());
  });
}

int barchan_get_types(barchan_sim* sim, int brick, const uint8_t** types, int64_t* size) {
  return with(sim, [&](Simulation& s) {
    require(types != nullptr && size != nullptr, kNowhere);
    const auto span = brick_of(s.owned(), brick).types();
    *types = span.data();
    *size = static_cast<int64_t>(span.size());
  });
}

int barchan_get_loads(barchan_sim* sim, int brick, barchan_loads* loads) {
  return with(sim, [&](Simulation& s) {
    require(loads != nullptr, kNowhere);
    const barchan::LoadView view = brick_of(s.loads(), brick);
    *loads = {view.forces().data(), view.torques_by_radius().data(),
              static_cast<int64_t>(view.size()), view.forces().stride()};
  });
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

}  // extern "C"
