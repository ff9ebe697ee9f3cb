#include <barchan/core/deck/not_modelled.hpp>

#include <algorithm>
#include <cctype>
#include <span>
#include <string>

namespace barchan::deck {

namespace {

// Beginnings of words, in lower case and with a space before each word.
constexpr std::string_view kTwisting[] = {" twisting f", " twisting s", " twisting d", " torsion",
                                          " spinning"};
constexpr std::string_view kCohesion[] = {" capillar",    " liquid",  " suction",  " van der",
                                          " bond number", " work of", " adhesive", " cohesive"};
constexpr std::string_view kElastic[] = {" elastic mod", " shear modulus", " bulk modulus"};
constexpr std::string_view kPoisson[] = {" poisson"};
constexpr std::string_view kLaws[] = {" contact law", " contact model", " law", " hysteresis",
                                      " walton"};
constexpr std::string_view kHeat[] = {" thermal", " specific heat", " heat transfer", " emissivity",
                                      " convecti"};
constexpr std::string_view kViscous[] = {" viscos"};
constexpr std::string_view kFluid[] = {" fluid",   " drag",    " buoyan", " pore",
                                       " permeab", " lubrica", " cfd"};
constexpr std::string_view kPlastic[] = {" yield", " plastic",  " unloading", " hardness",
                                         " wear",  " breakage", " fracture",  " crush"};
constexpr std::string_view kSpeed[] = {" static friction", " dynamic friction", " kinetic friction",
                                       " friction static", " friction dynamic", " friction kinetic",
                                       " static mu",       " dynamic mu",       " mu static"};
constexpr std::string_view kFields[] = {" charge", " electr", " magnet", " permittivity"};
constexpr std::string_view kCurved[] = {" cylind", " cone",   " curved", " mesh", " stl",
                                        " sphere", " circle", " arc",    " tube", " funnel"};
constexpr std::string_view kTurning[] = {" omega", " angular", " rotat", " spin", " turn", " tilt"};
constexpr std::string_view kShapes[] = {" shape",   " aspect",    " vertices", " clump",
                                        " mesh",    " stl",       " superq",   " polyh",
                                        " polygon", " ellipsoid", " capsule",  " rigid bod"};
constexpr std::string_view kServo[] = {" servo", " target stress", " stress control",
                                       " strain rate"};
constexpr std::string_view kSheared[] = {" lees edwards", " shear rate", " sheared", " deform"};
constexpr std::string_view kInflow[] = {" inflow", " inlet",     " insert",
                                        " feed",   " flow rate", " mass rate"};

struct Group {
  std::span<const std::string_view> beginnings;
  NotModelled answer;
  std::string_view table = {};  ///< in which alone the words mean this; empty: in any
};

constexpr Group kGroups[] = {
    {kTwisting,
     {"twisting by constants of its own is",
      "write twisting = \"marshall\" in [contact], which acts by friction and tangential "
      "stiffness"}},
    {kCohesion,
     {"adhesion by van der Waals forces at a distance, or by liquid that flows, is",
      "write model = \"jkr\", or adhesion = \"dmt\", \"sjkr\" or \"bridge\" of hertz contacts, in "
      "[contact], with surface_energy, cohesion_density or a [[bridge]]; a [[bond]] breaks for "
      "good"}},
    {kElastic,
     {"elasticity by any moduli but Young's modulus and Poisson's ratio is",
      "give young_modulus and poisson_ratio to materials, with model = \"hertz\" in [contact]; a "
      "[[bond]] has young_modulus and stiffness_ratio"}},
    {kPoisson,
     {"Poisson's ratio of a bond is", "give stiffness_ratio, normal over shear stiffness"},
     "[[bond]]"},
    {kLaws,
     {"any law of contact but linear springs and Hertz–Mindlin is",
      "choose one of these by `model` in [contact]"}},
    {kHeat,
     {"heat other than conduction through contacts is",
      "leave it out; with a table [heat] these two let it flow through contacts"}},
    {kViscous,
     {"viscosity is",
      "leave it out; give normal_damping or restitution for contacts that lose energy"}},
    {kFluid,
     {"a fluid is", "leave it out, or add its forces from a program: Simulation::apply_forces"}},
    {kPlastic,
     {"plastic deformation, wear and breakage of a particle are",
      "leave it out; bodies of bonded particles break at their bonds"}},
    {kSpeed,
     {"friction that depends on speed is",
      "give one coefficient per pair of materials, `friction`"}},
    {kFields,
     {"electric and magnetic forces are",
      "leave it out, or add them from a program: Simulation::apply_forces"}},
    {kCurved,
     {"any wall but planes and plates is",
      "write kind = \"plane\" or kind = \"plate\", or a source of fixed particles"},
     "[[wall]]"},
    {kTurning,
     {"a wall that turns is", "give a plane or plate a velocity, or a plate a load"},
     "[[wall]]"},
    {kShapes, {"any particle but disks and spheres is", "bond particles to a body"}},
    {kServo,
     {"control of a stress or a strain rate is", "give a plate a load, or a wall a velocity"}},
    {kSheared, {"sheared periodic borders are", "leave it out; periodic axes are straight"}},
    {kInflow, {"a source of particles during the run is", "give all particles at the start"}},
};

/// "RollingFriction" and "rolling_friction" become " rolling friction".
std::string in_words(std::string_view word) {
  std::string words;
  bool was_lower = false, was_letter = false;
  for (const char c : word) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) == 0) {
      was_letter = was_lower = false;
      continue;
    }
    const bool is_upper = std::isupper(letter) != 0;
    if (!was_letter || (was_lower && is_upper)) words += ' ';
    words += static_cast<char>(std::tolower(letter));
    was_letter = true;
    was_lower = !is_upper;
  }
  return words;
}

}  // namespace

std::optional<NotModelled> find_not_modelled(std::string_view table, std::string_view word) {
  const std::string words = in_words(word);
  for (const Group& group : kGroups) {
    if (!group.table.empty() && group.table != table) continue;
    const bool is_meant = std::ranges::any_of(group.beginnings, [&](std::string_view beginning) {
      return words.find(beginning) != std::string::npos;
    });
    if (is_meant) return group.answer;
  }
  return std::nullopt;
}

}  // namespace barchan::deck
