#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scenarios.hpp"

// The same models with other laws of contact, with many materials, and with heat.

namespace barchan::test {

/// Gives all contacts of a scenario in 3D elastic moduli. @param young_modulus  of the first
/// material; others are stiffer
inline void make_hertz(Scenario& s, double young_modulus, const ContactRules& rules) {
  const auto n = static_cast<int>(s.model.materials.size());
  s.model.contacts = {n, {}, rules.no_tension, 1, rules.tangential};
  std::vector<ContactConstants> own(static_cast<std::size_t>(n));
  for (int a = 0; a < n; ++a) {
    own[static_cast<std::size_t>(a)].young_modulus = (1.0 + a) * young_modulus;
    own[static_cast<std::size_t>(a)].poisson_ratio = 0.3 - 0.1 * a;
  }
  for (const ContactConstants& a : own) {
    for (const ContactConstants& b : own) {
      ContactConstants p = HertzMindlin::mix(a, b).value();
      p.mu = 0.4;
      p.restitution = 0.8;
      HertzMindlin::solve(p, rules);
      s.model.contacts.constants.push_back(p);
    }
  }
}

inline Scenario hertz_column() {
  Scenario s = column_collapse();
  s.name = "3D column collapse of elastic spheres";
  make_hertz(s, 2e6, {true, Tangential::Mindlin});
  return s;
}

inline Scenario hertz_gas() {
  Scenario s = gas(3, {true, false, true}, 3.0, "3D gas of two elastic materials, periodic");
  s.model.materials.push_back({"hard", 1000.0});
  for (ParticleData& p : s.set.particles) p.type = static_cast<std::int32_t>(p.id % 2);
  make_hertz(s, 2e6, {false, Tangential::MindlinDisplacement});
  return s;
}

/// Makes the contacts of a scenario resist rolling and, in 3D, twisting.
inline void make_rolling(Scenario& s) {
  s.model.contacts.law += 2;
  s.model.contacts.twisting = s.model.dimension == 3;
  for (ContactConstants& c : s.model.contacts.constants) c.mu_rolling = 0.1, c.cr = 0.2;
}

inline Scenario rolling_shear_flow() {
  Scenario s = shear_flow();
  s.name = "dense shear of disks that resist rolling";
  make_rolling(s);
  return s;
}

inline Scenario rolling_hertz_gas() {
  Scenario s = hertz_gas();
  s.name = "3D gas of elastic materials with rolling and twisting, periodic";
  make_rolling(s);
  return s;
}

/// Linear contacts by moduli and radii, which resist rolling.
inline Scenario shear_flow_by_radius() {
  Scenario s = shear_flow();
  s.name = "dense shear of disks as stiff as their radii make them";
  const int n = s.model.contacts.num_materials;
  const bool no_tension = s.model.contacts.no_tension;
  ContactConstants p;
  p.young_modulus = s.model.contacts.at(0, 0).kn / 0.05;
  p.mu = 0.4;
  p.restitution = 0.8;
  p = LinearByRadius::mix(p, p).value();
  LinearByRadius::solve(p, {no_tension});
  s.model.contacts = {n, std::vector<ContactConstants>(static_cast<std::size_t>(n * n), p),
                      no_tension, 9};
  make_rolling(s);
  return s;
}

/// @param adhesion  strong enough that some that meet stay together
inline Scenario sticky_gas(Adhesion adhesion, bool rolls) {
  Scenario s = hertz_gas();
  s.name = rolls ? "3D gas that sticks and rolls, periodic" : "3D gas that sticks, periodic";
  s.model.contacts.law = adhesion == Adhesion::None ? 6 : adhesion == Adhesion::Bridge ? 8 : 4;
  s.model.contacts.adhesion = adhesion;
  for (ContactConstants& c : s.model.contacts.constants) {
    c.surface_energy = 40.0, c.cohesion_density = 4e4;
    c.bridge = {10.0, 0.3, 1e-5};
    if (rolls) c.mu_rolling = 0.1, c.cr = 0.2;
  }
  s.model.contacts.law += rolls ? 1 : 0;
  s.model.contacts.twisting = rolls;
  return s;
}

/// JKR contacts.
inline Scenario attracting_gas(bool rolls) {
  Scenario s = sticky_gas(Adhesion::None, rolls);
  s.name = "3D gas that attracts itself, periodic";
  return s;
}

inline Scenario rolling_column() {
  Scenario s = column_collapse();
  s.name = "3D column collapse with rolling and twisting";
  make_rolling(s);
  return s;
}

/// Gives all of a scenario temperatures by their ids, and its walls one, a flux, or neither; what
/// contacts lose warms them, too.
inline Scenario with_heat(Scenario s, double conductivity) {
  s.name += ", with heat";
  s.num_steps /= 3;
  s.model.heat.is_on = true;
  s.model.heat.dissipation = true;
  s.model.output.energy = true;
  for (std::size_t a = 0; a < s.model.materials.size(); ++a) {
    s.model.materials[a].conductivity = conductivity * (1.0 + 0.5 * static_cast<double>(a));
    s.model.materials[a].heat_capacity = 10.0 + 3.0 * static_cast<double>(a);
  }
  for (std::size_t w = 0; w < s.model.walls.size(); ++w) {
    if (w % 3 == 0) s.model.walls[w].temperature = 350.0;
    if (w % 3 == 1) s.model.walls[w].heat_flux = 1e3;
  }
  for (ParticleData& p : s.set.particles)
    p.temperature = 290.0 + 17.0 * static_cast<double>(p.id % 7);
  return s;
}

/// @param num_materials  5 materials make 15 laws and the null law, more than a vector register
/// holds
inline Scenario many_laws(int num_materials, bool no_tension) {
  Scenario s =
      gas(2, {true, true, false}, 2.0,
          std::to_string(num_materials) + " materials" + (no_tension ? "" : ", with tension"));
  s.set = {};
  add_cloud(s.set, 2, {s.model.domain.lo, s.model.domain.hi, 0.105, 0.055, 2.0, 25});
  s.model.materials.assign(static_cast<std::size_t>(num_materials), {"grain", 1000.0});
  s.model.contacts = {
      num_materials,
      std::vector<ContactConstants>(static_cast<std::size_t>(num_materials * num_materials)),
      no_tension};
  for (int a = 0; a < num_materials; ++a) {
    for (int b = 0; b < num_materials; ++b) {
      ContactConstants c = soft_contact(1e4 + 3e3 * (a + b), 0.2 * (a + b));
      c.cn.constant = 3.0 + a + b;
      s.model.contacts.constants[static_cast<std::size_t>(a * num_materials + b)] = c;
    }
  }
  for (ParticleData& p : s.set.particles) p.type = static_cast<std::int32_t>(p.id % num_materials);
  shuffle_ids(s.set, 9);
  return s;
}

}  // namespace barchan::test
