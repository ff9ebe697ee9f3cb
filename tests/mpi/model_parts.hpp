#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <barchan/core/model/model.hpp>

// What the models of tests are made of: materials, boxes, clouds, bonds.

namespace barchan::test {

inline ContactConstants soft_contact(double kn, double mu) {
  ContactConstants c;
  c.kn = kn;
  c.kt = 0.4 * kn;
  c.mu = mu;
  c.cn.constant = 2.0;
  c.ct.constant = 1.0;
  return c;
}

/// Above the middle of a box of four metres, pressing down.
/// @param load  [N/m²], in 2D [N/m]. @param mass  [kg]
inline WallSpec loaded_plate(double height, double width, double load, double mass) {
  WallSpec plate;
  plate.name = "plate";
  plate.kind = WallKind::Plate;
  plate.point = Vec3(2.0, height, 0.0);
  plate.normal = Vec3(0.0, -1.0, 0.0);
  plate.width = width;
  plate.is_loaded = true;
  plate.load = load;
  plate.mass = mass;
  return plate;
}

/// One material, a box as deep as a metre, one stage. @param length  along x
inline Model plain_model(int dimension, double length, double height) {
  Model m;
  m.dimension = dimension;
  m.domain.hi = Vec3(length, dimension == 3 ? 1.0 : height, dimension == 3 ? height : 0.0);
  m.time.step = 2e-4;
  m.materials = {{"grain", 100.0}};
  m.contacts.num_materials = 1;
  m.contacts.constants = {soft_contact(1e5, 0.5)};
  m.stages = {Stage{}};
  return m;
}

inline void add_wall(Model& m, const Vec3& point, const Vec3& normal) {
  WallSpec w;
  w.name = "wall " + std::to_string(m.walls.size());
  w.point = point;
  w.normal = normal;
  m.walls.push_back(w);
}

inline void add_box_walls(Model& m) {
  for (int a = 0; a < m.dimension; ++a) {
    if (m.domain.periodic[static_cast<std::size_t>(a)]) continue;
    Vec3 n = Vec3::Zero();
    n[a] = 1.0;
    add_wall(m, m.domain.lo, n);
    add_wall(m, m.domain.hi, -n);
  }
}

struct Cloud {
  Vec3 lo, hi;
  double spacing;      ///< of a lattice, each point shaken a little
  double radius;       ///< the largest; the others down to 0.7 of it
  double speed = 0.0;  ///< of every particle, in a random direction
  unsigned seed = 1;
};

inline void add_cloud(ParticleSet& set, int dimension, const Cloud& c) {
  std::mt19937_64 random(c.seed);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto count = [&](int a) {
    return a < dimension ? std::max(1, static_cast<int>((c.hi[a] - c.lo[a]) / c.spacing)) : 1;
  };
  for (int i = 0; i < count(0); ++i) {
    for (int j = 0; j < count(1); ++j) {
      for (int k = 0; k < count(2); ++k) {
        ParticleData p;
        p.id = static_cast<std::int64_t>(set.particles.size()) + 1;
        p.radius = c.radius * (0.85 + 0.15 * any(random));
        p.density = dimension == 2 ? 100.0 : 1000.0;
        const Vec3 at(i + 0.5, j + 0.5, k + 0.5);
        for (int a = 0; a < dimension; ++a) {
          p.position[a] = c.lo[a] + c.spacing * (at[a] + 0.04 * any(random));
          p.velocity[a] = any(random);
        }
        p.velocity *= c.speed / (1e-9 + p.velocity.norm());
        if (dimension == 3)
          p.omega = Vec3(any(random), any(random), any(random));
        else
          p.omega[2] = 5.0 * any(random);
        set.particles.push_back(p);
      }
    }
  }
}

/// Ids no longer follow positions, so that an order by id alone would show.
inline void shuffle_ids(ParticleSet& set, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<std::int64_t> ids;
  for (const auto& p : set.particles) ids.push_back(p.id);
  for (std::size_t i = ids.size(); i > 1; --i) std::swap(ids[i - 1], ids[random() % i]);
  for (BondData& b : set.bonds) {
    b.id_a = ids[static_cast<std::size_t>(b.id_a - 1)];
    b.id_b = ids[static_cast<std::size_t>(b.id_b - 1)];
    if (b.id_a > b.id_b) std::swap(b.id_a, b.id_b);
  }
  for (std::size_t i = 0; i < ids.size(); ++i) set.particles[i].id = ids[i];
}

/// Bonds all neighbours closer than `reach` times the sum of radii among particles [begin, end).
inline void bond_near(ParticleSet& set, std::size_t begin, std::size_t end, double reach) {
  for (std::size_t p = begin; p < end; ++p) {
    for (std::size_t q = p + 1; q < end; ++q) {
      const auto &a = set.particles[p], &b = set.particles[q];
      if ((a.position - b.position).norm() < reach * (a.radius + b.radius)) {
        set.bonds.push_back({a.id, b.id, 0});
      }
    }
  }
}

inline BondLaw weak_bond(double strength) {
  BondLaw law;
  law.name = "cement";
  law.young_modulus = 2e4;
  law.damping_ratio = 0.1;
  law.tensile_strength = strength;
  law.shear_strength = strength;
  return law;
}

}  // namespace barchan::test
