#include <barchan/core/deck/not_modelled.hpp>

#include <algorithm>
#include <span>

namespace barchan::deck {

namespace {

constexpr std::string_view kRolling[] = {
    "rolling_friction",  "rolling_resistance", "rolling_stiffness",   "rolling_damping",
    "twisting_friction", "twisting_stiffness", "torsional_friction",  "spinning_friction",
    "rolling_viscosity", "rolling_moment",     "coefficient_rolling", "twisting_damping"};
constexpr std::string_view kCohesion[] = {
    "cohesion",       "adhesion",        "cohesion_energy",   "cohesion_energy_density",
    "surface_energy", "surface_tension", "work_of_adhesion",  "capillary_force",
    "liquid_volume",  "contact_angle",   "cohesive_strength", "pull_off_force"};
constexpr std::string_view kElastic[] = {
    "young_modulus",  "youngs_modulus", "young",         "elastic_modulus", "poisson_ratio",
    "poissons_ratio", "poisson",        "shear_modulus", "bulk_modulus",    "hertz_stiffness"};
constexpr std::string_view kHeat[] = {"temperature",   "thermal_conductivity", "conductivity",
                                      "heat_capacity", "specific_heat",        "thermal_capacity",
                                      "heat_transfer", "thermal_expansion"};
constexpr std::string_view kFluid[] = {"viscosity",      "fluid_viscosity",  "fluid_density",
                                       "drag",           "drag_coefficient", "buoyancy",
                                       "fluid_velocity", "pore_pressure",    "lubrication"};
constexpr std::string_view kPlastic[] = {
    "yield_stress", "yield_strength", "plasticity", "unloading_stiffness",
    "hardness",     "wear",           "breakage",   "fracture_energy"};
constexpr std::string_view kSpeed[] = {"static_friction", "dynamic_friction", "kinetic_friction",
                                       "friction_static", "friction_dynamic"};
constexpr std::string_view kFields[] = {"charge", "electric_field", "magnetic_field",
                                        "magnetic_moment", "permittivity"};
constexpr std::string_view kShapes[] = {"shape", "aspect_ratio", "vertices",
                                        "clump", "mesh",         "stl"};

struct Group {
  std::span<const std::string_view> keys;
  NotModelled answer;
};

constexpr Group kGroups[] = {
    {kRolling,
     {"resistance to rolling and twisting is", "leave it out; `friction` acts on sliding alone"}},
    {kCohesion,
     {"cohesion is",
      "leave it out; a [[bond]] has tensile_strength and shear_strength, and breaks "
      "for good"}},
    {kElastic,
     {"contact by elastic moduli (Hertz) is",
      "give normal_stiffness and tangential_stiffness in N/m; young_modulus and stiffness_ratio "
      "belong to a [[bond]]"}},
    {kHeat, {"heat is", "leave it out"}},
    {kFluid,
     {"a fluid is", "leave it out, or add its forces from a program: Simulation::apply_forces"}},
    {kPlastic,
     {"plastic deformation and breakage of a particle are",
      "leave it out; bodies of bonded particles break at their bonds"}},
    {kSpeed,
     {"friction that depends on speed is",
      "give one coefficient per pair of materials, `friction`"}},
    {kFields,
     {"electric and magnetic forces are",
      "leave it out, or add them from a program: Simulation::apply_forces"}},
    {kShapes, {"any shape but disks, spheres, planes and plates is", "bond particles to a body"}},
};

}  // namespace

std::optional<NotModelled> find_not_modelled(std::string_view key) {
  for (const Group& group : kGroups) {
    if (std::ranges::find(group.keys, key) != group.keys.end()) return group.answer;
  }
  return std::nullopt;
}

}  // namespace barchan::deck
