#include <barchan/core/deck/schema_keys.hpp>

namespace barchan::deck {

namespace {

using T = ValueType;

constexpr KeySpec kPhysicsKeys[] = {
    {"[[material]]", "name", T::String, "", "required", "unique"},
    {"[[material]]", "density", T::PositiveNumber, "kg/m³, 2D kg/m²", "required",
     "of a particle's own body"},
    {"[[material]]", "normal_stiffness", T::PositiveNumber, "N/m", "none",
     "spring of two particles of this material; without it every pair needs a `[[pair]]`"},
    {"[[material]]", "tangential_stiffness", T::NonNegativeNumber, "N/m", "0", "tangential spring"},
    {"[[material]]", "normal_damping", T::NonNegativeNumber, "N·s/m", "0", "dashpot coefficient"},
    {"[[material]]", "normal_damping_rate", T::NonNegativeNumber, "1/s", "none",
     "dashpot coefficient per effective mass of the pair, instead of `normal_damping`"},
    {"[[material]]", "restitution", T::Restitution, "", "none",
     "ratio of normal speeds after and before a collision, instead of `normal_damping`"},
    {"[[material]]", "tangential_damping", T::NonNegativeNumber, "N·s/m", "0",
     "tangential dashpot"},
    {"[[material]]", "tangential_damping_rate", T::NonNegativeNumber, "1/s", "none",
     "per effective mass of the pair, instead of `tangential_damping`"},
    {"[[material]]", "friction", T::NonNegativeNumber, "", "0", "Coulomb coefficient"},

    {"[[pair]]", "materials", T::Names, "", "required",
     "the names of two materials, which may be the same"},
    {"[[pair]]", "normal_stiffness", T::PositiveNumber, "N/m", "required", "normal spring"},
    {"[[pair]]", "tangential_stiffness", T::NonNegativeNumber, "N/m", "0", "tangential spring"},
    {"[[pair]]", "normal_damping", T::NonNegativeNumber, "N·s/m", "0", "dashpot coefficient"},
    {"[[pair]]", "normal_damping_rate", T::NonNegativeNumber, "1/s", "none",
     "per effective mass of the pair, instead of `normal_damping`"},
    {"[[pair]]", "restitution", T::Restitution, "", "none",
     "ratio of normal speeds after and before a collision, instead of `normal_damping`"},
    {"[[pair]]", "tangential_damping", T::NonNegativeNumber, "N·s/m", "0", "tangential dashpot"},
    {"[[pair]]", "tangential_damping_rate", T::NonNegativeNumber, "1/s", "none",
     "per effective mass of the pair, instead of `tangential_damping`"},
    {"[[pair]]", "friction", T::NonNegativeNumber, "", "0", "Coulomb coefficient"},

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
};

}  // namespace

std::span<const KeySpec> physics_keys() {
  return kPhysicsKeys;
}

}  // namespace barchan::deck
