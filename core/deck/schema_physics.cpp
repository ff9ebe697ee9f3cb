#include <algorithm>
#include <string_view>
#include <vector>

#include <barchan/core/deck/schema_keys.hpp>
#include <barchan/core/laws/laws.hpp>

namespace barchan::deck {

namespace {

using T = ValueType;

constexpr KeySpec kPhysicsKeys[] = {
    {"[[material]]", "name", T::String, "", "required", "unique"},
    {"[[material]]", "density", T::PositiveNumber, "kg/m³, 2D kg/m²", "required",
     "of a particle's own body"},
    {"[[material]]", "conductivity", T::PositiveNumber, "W/(m·K)", "none",
     "of heat; with `[heat]` what particles are made of needs it"},
    {"[[material]]", "heat_capacity", T::PositiveNumber, "J/(kg·K)", "none",
     "per mass; with `[heat]` what particles are made of needs it"},
    {"[[pair]]", "materials", T::Names, "", "required",
     "the names of two materials, which may be the same"},
    {"[[bridge]]", "materials", T::Names, "", "required",
     "the names of two materials, which may be the same"},
    {"[[bridge]]", "surface_tension", T::PositiveNumber, "N/m", "required",
     "of the liquid; water has 0.072"},
    {"[[bridge]]", "contact_angle", T::NonNegativeNumber, "degrees", "0",
     "between liquid and surface, below 90"},
    {"[[bridge]]", "volume", T::PositiveNumber, "m³", "required", "of each bridge"},
    {"[contact]", "model", T::Choice, "", "linear",
     "`linear`: springs of a given stiffness; `hertz`: elastic spheres by `young_modulus` and "
     "`poisson_ratio`, in 3D; `jkr`: the same with surfaces that attract each other, by "
     "`surface_energy`",
     "linear|hertz|jkr"},
    {"[contact]", "stiffness", T::Choice, "", "given",
     "of linear contacts: `given` by `normal_stiffness` and `tangential_stiffness`; `radius`: by "
     "`young_modulus` and the radii, 2·E·R",
     "given|radius"},
    {"[contact]", "tangential", T::Choice, "", "mindlin",
     "of hertz and jkr contacts: `mindlin` adds up increments of force and takes back on unloading "
     "what the smaller area cannot bear; `mindlin-displacement` multiplies displacement by "
     "stiffness",
     "mindlin|mindlin-displacement"},
    {"[contact]", "rolling", T::Choice, "", "none",
     "`spring`: contacts resist rolling, by `rolling_friction` and the keys beside it",
     "none|spring"},
    {"[contact]", "twisting", T::Choice, "", "none",
     "`marshall`: contacts of spheres resist twisting about their normal, by `friction`",
     "none|marshall"},
    {"[contact]", "adhesion", T::Choice, "", "none",
     "of hertz contacts: while they touch, `dmt` pulls by `surface_energy`, `sjkr` and `sjkr2` by "
     "`cohesion_density`; `bridge`: liquid pulls until it ruptures, see `[[bridge]]`",
     "none|dmt|sjkr|sjkr2|bridge"},
    {"[contact]", "pull_off", T::Choice, "", "limit",
     "of jkr contacts, where one that is pulled apart ends: `limit`: where no balance is left, "
     "with 5/9 of the largest pull; `peak`: at the largest pull",
     "limit|peak"},
    {"[contact]", "reference_speed", T::PositiveNumber, "m/s", "of the start and of falls",
     "of hertz and jkr contacts: the impact that the stable step allows for"},
    {"[contact]", "no_tension", T::Boolean, "", "true",
     "a contact never pulls: the normal force is held at zero where the dashpot outweighs the "
     "spring"},
    {"[contact]", "mixing", T::Choice, "", "harmonic",
     "how pairs without a `[[pair]]` get their constants; `none` requires a `[[pair]]` for every "
     "pair",
     "harmonic|none"},

    {"[[bond]]", "name", T::String, "", "required", "unique"},
    {"[[bond]]", "young_modulus", T::PositiveNumber, "Pa", "none",
     "E of the beam; this or `normal_stiffness`"},
    {"[[bond]]", "normal_stiffness", T::PositiveNumber, "Pa/m", "none",
     "per section area, whatever the bond's length; this or `young_modulus`"},
    {"[[bond]]", "stiffness_ratio", T::PositiveNumber, "", "2.5", "normal over shear stiffness"},
    {"[[bond]]", "radius_factor", T::PositiveNumber, "", "1",
     "half height (2D) or radius (3D) of the section over the smaller particle radius"},
    {"[[bond]]", "damping_ratio", T::NonNegativeNumber, "", "0",
     "of critical damping, between the two ends"},
    {"[[bond]]", "tensile_strength", T::PositiveNumber, "Pa", "none",
     "largest stress that the bond bears; none = it never breaks"},
    {"[[bond]]", "shear_strength", T::PositiveNumber, "Pa", "none",
     "largest stress that the bond bears; none = it never breaks"},

    {"[[wall]]", "name", T::String, "", "required", "unique"},
    {"[[wall]]", "kind", T::Choice, "", "plane",
     "`plane` fills the half-space behind it, `plate` is a face of finite width", "plane|plate"},
    {"[[wall]]", "point", T::Vector, "m", "required", "on the plane; the middle of a plate"},
    {"[[wall]]", "normal", T::Vector, "", "required",
     "towards the particles, of any length but zero"},
    {"[[wall]]", "material", T::String, "", "required", "name of a material"},
    {"[[wall]]", "velocity", T::Vector, "m/s", "zero", "constant; of a loaded plate, at its start"},
    {"[[wall]]", "width", T::PositiveNumber, "m", "none",
     "plate only, required: across the normal; in 3D along the axis least aligned with it"},
    {"[[wall]]", "depth", T::PositiveNumber, "m", "none",
     "plate in 3D only, required: across normal and width"},
    {"[[wall]]", "load", T::NonNegativeNumber, "N/m²", "none",
     "plate only: pressure that pushes it along its normal; such a plate moves along its normal "
     "only"},
    {"[[wall]]", "mass", T::PositiveNumber, "kg", "none", "of a loaded plate, required there"},
    {"[[wall]]", "damping", T::NonNegativeNumber, "N·s/m", "0", "viscous, on a loaded plate"},
    {"[[wall]]", "from_stage", T::String, "", "the first stage",
     "name of the stage at which the wall appears"},
    {"[[wall]]", "temperature", T::NonNegativeNumber, "K", "none",
     "that the wall keeps; this or `heat_flux`, or no heat goes through it"},
    {"[[wall]]", "heat_flux", T::Number, "W/m²", "none",
     "into every particle that touches the wall, times its cross-section (disks: its diameter)"},
};

}  // namespace

std::span<const KeySpec> physics_keys() {
  return kPhysicsKeys;
}

namespace {

T type_of(LawKey::Range range) {
  switch (range) {
    case LawKey::Range::Positive:
      return T::PositiveNumber;
    case LawKey::Range::Restitution:
      return T::Restitution;
    case LawKey::Range::Poisson:
      return T::PoissonRatio;
    case LawKey::Range::Flag:
      return T::Boolean;
    case LawKey::Range::NotNegative:
      break;
  }
  return T::NonNegativeNumber;
}

/// Laws may share keys: the first one explains them.
template <class Law, class... Rest>
void add_keys(LawList<Law, Rest...> /*laws*/, std::vector<KeySpec>& to) {
  for (const LawKey& key : Law::keys()) {
    const bool is_known =
        std::any_of(to.begin(), to.end(), [&](const KeySpec& k) { return k.key == key.name; });
    if (is_known) continue;
    for (const char* table : {"[[material]]", "[[pair]]"}) {
      if (key.is_of_material && table == std::string_view("[[pair]]")) continue;
      to.push_back({table, key.name, type_of(key.range), key.unit, key.fallback, key.meaning});
    }
  }
  if constexpr (sizeof...(Rest) > 0) add_keys(LawList<Rest...>{}, to);
}

}  // namespace

std::span<const KeySpec> law_keys() {
  static const std::vector<KeySpec> keys = [] {
    std::vector<KeySpec> of_laws;
    add_keys(Laws{}, of_laws);
    return of_laws;
  }();
  return keys;
}

}  // namespace barchan::deck
