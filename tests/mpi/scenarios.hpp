#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <barchan/core/links/wall_shape.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/core/search/grid.hpp>
#include <barchan/tasks/simulation.hpp>

#include "model_parts.hpp"

// Small models that are hard on the engine: what crosses cuts, breaks there, or leaves strips
// empty.

namespace barchan::test {

struct Scenario {
  std::string name;
  Model model;
  ParticleSet set;
  std::int64_t num_steps = 300;
  std::function<Vec3(const OwnedParticle&)> force;  ///< set once in a while, if any
  bool must_migrate = true;                         ///< particles cross cuts on several ranks
};

inline Scenario soil_with_ring_and_plate() {
  Scenario s{
      "soil with a bonded ring under a loaded plate", plain_model(2, 4.0, 2.0), {}, 600, {}, false};
  Model& m = s.model;
  m.gravity = Vec3(0.0, -9.81, 0.0);
  const Vec3 middle(2.0, 0.5, 0.0);
  constexpr int kRing = 16;
  for (int q = 0; q < kRing; ++q) {
    const double angle = 2.0 * 3.14159265358979 * q / kRing;
    ParticleData p;
    p.id = q + 1;
    p.type = 1;
    p.radius = 0.058;
    p.density = 150.0;
    p.position = middle + 0.3 * Vec3(std::cos(angle), std::sin(angle), 0.0);
    s.set.particles.push_back(p);
  }
  bond_near(s.set, 0, kRing, 1.2);
  ParticleSet soil;
  add_cloud(soil, 2, {{0.0, 0.0, 0.0}, {4.0, 1.2, 0.0}, 0.095, 0.053, 0.1, 3});
  for (ParticleData p : soil.particles) {
    if ((p.position - middle).norm() < 0.45) continue;
    p.id = static_cast<std::int64_t>(s.set.particles.size()) + 1;
    s.set.particles.push_back(p);
  }
  m.materials.push_back({"pipe", 150.0});
  m.contacts = {2,
                {soft_contact(2e4, 0.5), soft_contact(1e4, 0.1), soft_contact(1e4, 0.1),
                 soft_contact(3e4, 0.9)},
                true};
  m.bond_laws = {weak_bond(std::numeric_limits<double>::infinity())};
  add_box_walls(m);
  m.walls.push_back(loaded_plate(1.25, 1.0, 50.0, 5.0));
  m.walls.back().damping = 50.0;
  m.walls.back().from_stage = 1;
  m.stages = {Stage{"settle", 0.3, 0.02, 0.0}, Stage{"load", 0.1}};
  shuffle_ids(s.set, 1);
  return s;
}

inline Scenario column_collapse() {
  Scenario s{"3D column collapse with restitution", plain_model(3, 3.0, 1.5), {}, 250, {}, false};
  s.model.gravity = Vec3(1.0, 0.0, -9.81);
  ContactConstants& c = s.model.contacts.constants[0];
  c.cn = {0.0, 0.0, 0.4 * std::sqrt(c.kn)};
  c.ct = {0.0, 10.0, 0.0};
  add_box_walls(s.model);
  add_cloud(s.set, 3, {{0.6, 0.2, 0.0}, {2.4, 0.8, 0.7}, 0.105, 0.057, 1.5, 5});
  shuffle_ids(s.set, 2);
  return s;
}

/// @param speed  [m/s]; a particle crosses several slabs of 0.13 m in the run
inline Scenario gas(int dimension, std::array<bool, 3> periodic, double speed,
                    const std::string& name) {
  Scenario s{name, plain_model(dimension, 4.0, 1.0), {}, 400, {}, true};
  s.model.domain.periodic = periodic;
  s.model.contacts.constants[0].cn.constant = 0.05;
  add_box_walls(s.model);
  const double spacing = dimension == 2 ? 0.14 : 0.2;
  add_cloud(
      s.set, dimension,
      {s.model.domain.lo, s.model.domain.hi, spacing, dimension == 2 ? 0.055 : 0.06, speed, 9});
  shuffle_ids(s.set, 3);
  return s;
}

/// Of millions of cells all but a few hundred are empty.
inline Scenario gas_in_a_corner() {
  Scenario s = gas(3, {true, false, false}, 6.0, "gas in a corner of a vast domain");
  s.model.domain.hi += Vec3(0.0, 40.0, 40.0);
  return s;
}

inline Scenario shear_flow() {
  Scenario s = gas(2, {true, false, false}, 0.5, "dense shear, periodic along the strips");
  s.set = {};
  add_cloud(s.set, 2, {s.model.domain.lo, s.model.domain.hi, 0.1, 0.053, 0.2, 11});
  for (ParticleData& p : s.set.particles) p.velocity[0] += 8.0 * (p.position[1] - 0.5);
  s.model.contacts.constants[0].mu = 1.5;
  shuffle_ids(s.set, 4);
  return s;
}

inline Scenario expansion() {
  Scenario s{"a cloud expands into empty strips", plain_model(2, 6.0, 1.0), {}, 900, {}, true};
  add_box_walls(s.model);
  add_cloud(s.set, 2, {{0.0, 0.0, 0.0}, {1.2, 1.0, 0.0}, 0.1, 0.05, 2.0, 13});
  for (ParticleData& p : s.set.particles) p.velocity[0] += 8.0 * p.position[0];
  shuffle_ids(s.set, 5);
  return s;
}

inline Scenario one_slab() {
  Scenario s{"all particles in one slab", plain_model(2, 4.0, 1.0), {}, 300, {}, false};
  add_box_walls(s.model);
  s.model.gravity = Vec3(0.0, -9.81, 0.0);
  add_cloud(s.set, 2, {{3.0, 0.0, 0.0}, {3.11, 1.0, 0.0}, 0.1, 0.05, 0.2, 15});
  return s;
}

inline Scenario two_particles(bool periodic) {
  Scenario s{"fewer particles than ranks", plain_model(2, 4.0, 1.0), {}, 500, {}, false};
  s.model.domain.periodic[0] = periodic;
  s.model.search.skin = 0.03;
  ParticleData p;
  p.id = 7;
  p.radius = 0.06;
  p.density = 1000.0;
  p.position = Vec3(periodic ? 0.2 : 1.9, 0.5, 0.0);
  p.velocity = Vec3(periodic ? -4.0 : 4.0, 0.3, 0.0);
  s.set.particles.push_back(p);
  p.id = 3;
  p.position = Vec3(periodic ? 3.85 : 2.1, 0.53, 0.0);
  p.velocity = Vec3(periodic ? 3.0 : -3.0, 0.0, 0.0);
  s.set.particles.push_back(p);
  return s;
}

inline Scenario moving_walls() {
  Scenario s{"walls that move", plain_model(2, 4.0, 1.0), {}, 400, {}, false};
  add_wall(s.model, {0.05, 0.0, 0.0}, {1.0, 0.0, 0.0});
  s.model.walls.back().velocity = Vec3(2.0, 0.0, 0.0);
  add_wall(s.model, {4.0, 0.0, 0.0}, {-1.0, 0.0, 0.0});
  add_wall(s.model, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  s.model.walls.back().velocity = Vec3(1.5, 0.0, 0.0);  // slides in its own plane
  add_wall(s.model, {0.0, 1.0, 0.0}, {0.0, -1.0, 0.0});
  s.model.gravity = Vec3(0.0, -9.81, 0.0);
  add_cloud(s.set, 2, {{0.1, 0.0, 0.0}, {3.9, 0.6, 0.0}, 0.11, 0.05, 0.5, 17});
  shuffle_ids(s.set, 6);
  return s;
}

/// A fence that goes through one border, a loaded piston that goes through it the other way, and a
/// shelf across it, each with ends that particles touch; all borders wrap.
inline Scenario plates_at_borders() {
  Scenario s = gas(2, {true, true, false}, 2.0, "plates at periodic borders");
  const auto add = [&s](const Vec3& point, const Vec3& normal, double width) -> WallSpec& {
    add_wall(s.model, point, normal);
    WallSpec& w = s.model.walls.back();
    w.kind = WallKind::Plate;
    w.width = width;
    return w;
  };
  add({3.97, 0.9, 0.0}, {0.8, 0.6, 0.0}, 0.6).velocity = Vec3(1.5, 0.5, 0.0);
  WallSpec& piston = add({0.06, 0.5, 0.0}, {-1.0, 0.0, 0.0}, 0.4);
  piston.is_loaded = true;
  piston.load = 400.0;
  piston.mass = 4.0;
  add({3.9, 0.45, 0.0}, {0.0, 1.0, 0.0}, 0.9);
  add({2.0, 0.02, 0.0}, {0.0, -1.0, 0.0}, 4.0).velocity = Vec3(0.0, -0.5, 0.0);
  const PeriodicBox box = periodic_box(s.model.domain, 2);
  std::erase_if(s.set.particles, [&](const ParticleData& p) {
    return std::any_of(s.model.walls.begin(), s.model.walls.end(), [&](const WallSpec& w) {
      return WallShape<2>(w, box).foot(w.point, p.position.data()).distance < 0.9 * p.radius;
    });
  });
  return s;
}

inline Scenario rough_bed() {
  Scenario s{"free particles on fixed ones", plain_model(2, 4.0, 1.0), {}, 400, {}, true};
  s.model.gravity = Vec3(6.0, -9.81, 0.0);
  ContactConstants& c = s.model.contacts.constants[0];
  c.cn = {0.0, 20.0, 0.1 * std::sqrt(c.kn)};
  s.model.domain.periodic[0] = true;
  add_cloud(s.set, 2, {{0.0, 0.05, 0.0}, {4.0, 0.15, 0.0}, 0.1, 0.05, 0.0, 19});
  for (ParticleData& p : s.set.particles) {
    p.fixed = true;
    p.omega = Vec3::Zero();
  }
  add_cloud(s.set, 2, {{0.0, 0.18, 0.0}, {4.0, 0.7, 0.0}, 0.11, 0.05, 0.3, 21});
  for (ParticleData& p : s.set.particles) {
    if (!p.fixed) p.velocity[0] += 3.0;
  }
  shuffle_ids(s.set, 7);
  return s;
}

inline Scenario pushed_by_caller() {
  Scenario s = gas(2, {false, true, false}, 3.0, "forces of the caller, with migration");
  s.force = [](const OwnedParticle& p) -> Vec3 {
    return Vec3(-2.0 * p.velocity[0] + 2.0 * std::sqrt(static_cast<double>(p.id)),
                -0.5 * p.mass * p.position[1], 0.0);
  };
  return s;
}

inline Scenario breaking_plate(int dimension) {
  Scenario s{"bonds break at cuts, " + std::to_string(dimension) + "D",
             plain_model(dimension, 4.0, 1.5),
             {},
             400,
             {},
             true};
  s.model.bond_laws = {weak_bond(dimension == 2 ? 700.0 : 500.0)};
  s.model.domain.periodic[0] = dimension == 3;
  add_box_walls(s.model);
  add_cloud(s.set, dimension,
            {{0.3, 0.2, 0.2}, {3.6, dimension == 2 ? 0.7 : 0.5, 0.5}, 0.11, 0.055, 1.0, 23});
  bond_near(s.set, 0, s.set.particles.size(), 1.3);
  const int up = dimension - 1;
  for (ParticleData& p : s.set.particles) {
    p.velocity[up] -= 2.0 * std::sin(4.0 * p.position[0]);
    p.velocity[0] += 4.0;
  }
  shuffle_ids(s.set, 8);
  return s;
}

/// Bonds across gaps, longer or shorter than their lengths and sheared from the start, as a file
/// may have them.
inline Scenario stressed_net(int dimension) {
  Scenario s{"a net of stressed bonds, " + std::to_string(dimension) + "D",
             plain_model(dimension, 4.0, 1.0),
             {},
             100,
             {},
             true};
  s.model.bond_laws = {weak_bond(std::numeric_limits<double>::infinity())};
  s.model.domain.periodic[0] = true;
  add_cloud(s.set, dimension, {{0.1, 0.1, 0.1}, {3.9, 0.9, 0.9}, 0.2, 0.06, 0.5, 27});
  bond_near(s.set, 0, s.set.particles.size(), 1.95);
  for (std::size_t b = 0; b < s.set.bonds.size(); ++b) {
    BondData& bond = s.set.bonds[b];
    const auto part = static_cast<double>(b % 7);
    bond.length = 0.19 + 0.003 * part;
    bond.shear = Vec3(0.1 * part, 0.0, 0.0);
    bond.bending = Vec3(0.0, 0.0, 0.002 * part);
    if (dimension == 3) bond.twisting = 0.001 * part;
  }
  for (ParticleData& p : s.set.particles) p.velocity[0] += 4.0;
  shuffle_ids(s.set, 10);
  return s;
}

inline Scenario strips_along_y() {
  Scenario s = gas(2, {true, true, false}, 4.0, "strips along y, both axes periodic");
  std::swap(s.model.domain.hi[0], s.model.domain.hi[1]);
  s.model.domain.strip_axis = 1;
  for (ParticleData& p : s.set.particles) std::swap(p.position[0], p.position[1]);
  return s;
}

}  // namespace barchan::test
