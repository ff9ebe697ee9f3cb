#include <barchan/core/deck/schema_keys.hpp>

namespace barchan::deck {

namespace {

using T = ValueType;

constexpr KeySpec kParticleKeys[] = {
    {"[[particles]]", "kind", T::Choice, "", "required",
     "kind of source; its own keys follow below", "file|lattice|packing|ring|list"},
    {"[[particles]]", "material", T::String, "", "required; file: the `type` column",
     "name of a material"},
    {"[[particles]]", "density", T::PositiveNumber, "kg/m³, 2D kg/m²", "the material's",
     "instead of it"},
    {"[[particles]]", "velocity", T::Vector, "m/s", "zero",
     "at the start; added to that of a file"},
    {"[[particles]]", "omega", T::Spin, "rad/s", "zero",
     "angular velocity at the start; added to that of a file; in 2D about z"},
    {"[[particles]]", "temperature", T::NonNegativeNumber, "K", "that of `[heat]`",
     "at the start; of a file instead of its own"},
    {"[[particles]]", "bond", T::String, "", "none",
     "name of a bond law that links those of this source that touch; of a file with bonds, the law "
     "of them all"},
    {"[[particles]]", "bond_gap", T::NonNegativeNumber, "m", "1e-6 of the radii's sum",
     "gap between surfaces up to which `bond` links two particles"},
    {"[[particles]]", "bond_pairs", T::Pairs, "", "none",
     "ids that `bond` links, whether they touch or not, instead of those that touch"},
    {"[[particles]]", "fixed", T::Fixed, "", "false",
     "particles that never move: all of them, or those with centres in a box `{ lo = ..., hi = ... "
     "}`"},

    {"file", "path", T::String, "", "required",
     "`.csv` or `.tsv` with a header, LAMMPS data `.data` or `.lmp`, snapshot `.vtp` or `.pvtp`, "
     "each also as `.gz`; relative to the deck"},
    {"file", "data_density", T::Choice, "", "sphere",
     "what densities of LAMMPS data mean in 2D: `sphere`, mass 4/3·π·r³·density, as LAMMPS takes "
     "them; `disk`, mass π·r²·density, as everywhere else",
     "sphere|disk"},

    {"lattice", "region", T::Table, "m", "required",
     "box `{ lo = ..., hi = ... }` that holds the particles"},
    {"lattice", "radius", T::Radius, "m", "required", "one radius, a range, or classes"},
    {"lattice", "spacing", T::PositiveNumber, "m", "twice the largest radius",
     "between nearest sites; the first site lies half of it from `lo`"},
    {"lattice", "arrangement", T::Choice, "", "square or cubic",
     "of the sites: 2D square, hexagonal; 3D cubic, fcc", "square|hexagonal|cubic|fcc"},
    {"lattice", "jitter", T::Fraction, "", "0",
     "random shift, as a share of the free gap about a particle"},
    {"lattice", "seed", T::NonNegativeInteger, "", "1", "of the random radii and shifts"},

    {"packing", "region", T::Table, "m", "required",
     "box `{ lo = ..., hi = ... }` that holds the particles"},
    {"packing", "radius", T::Radius, "m", "required", "one radius, a range, or classes"},
    {"packing", "count", T::PositiveInteger, "", "none", "particles; this or `solid_fraction`"},
    {"packing", "solid_fraction", T::ProperFraction, "", "none",
     "share of the region, less its holes, that particles fill; this or `count`"},
    {"packing", "holes", T::Tables, "", "none",
     "disks or spheres that no particle reaches into; they may overlap and reach out of the "
     "region"},
    {"packing", "seed", T::NonNegativeInteger, "", "1", "of the random radii and positions"},

    {"ring", "center", T::Vector, "m", "required", "of the ring (2D only)"},
    {"ring", "radius", T::PositiveNumber, "m", "required",
     "from the centre to the centres of the disks"},
    {"ring", "count", T::PositiveInteger, "", "required", "disks, at least 3"},
    {"ring", "disk_radius", T::PositiveNumber, "m", "radius · sin(π / count)",
     "by default neighbours just touch"},
    {"ring", "start_angle", T::Number, "rad", "0",
     "of the first disk from the x axis, counter-clockwise"},

    {"list", "particle", T::Tables, "", "required", "the particles, one table each"},

    {"particle", "position", T::Vector, "m", "required", "centre"},
    {"particle", "radius", T::PositiveNumber, "m", "required", "of the disk or sphere"},
    {"particle", "velocity", T::Vector, "m/s", "that of the source", "at the start"},
    {"particle", "omega", T::Spin, "rad/s", "that of the source", "at the start; in 2D about z"},
    {"particle", "material", T::String, "", "that of the source", "name of a material"},
    {"particle", "density", T::PositiveNumber, "kg/m³, 2D kg/m²", "that of the source",
     "instead of the material's"},
    {"particle", "temperature", T::NonNegativeNumber, "K", "that of the source", "at the start"},

    {"box", "lo", T::Vector, "m", "required", "lower corner"},
    {"box", "hi", T::Vector, "m", "required", "upper corner"},

    {"hole", "center", T::Vector, "m", "required", "of the disk or sphere kept free"},
    {"hole", "radius", T::PositiveNumber, "m", "required", "of it"},

    {"size class", "radius", T::PositiveNumber, "m", "required", "of the particles in this class"},
    {"size class", "weight", T::PositiveNumber, "", "1",
     "share by number, relative to the other classes"},
};

}  // namespace

std::span<const KeySpec> particle_keys() {
  return kParticleKeys;
}

}  // namespace barchan::deck
