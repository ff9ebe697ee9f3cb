#include <barchan/core/deck/schema_keys.hpp>

namespace barchan::deck {

namespace {

using T = ValueType;

constexpr KeySpec kRunKeys[] = {
    {"deck", "title", T::String, "", "none", "a line about the run, kept in its results"},
    {"deck", "dimension", T::Integer, "", "required",
     "2 for disks of unit thickness, 3 for spheres"},
    {"deck", "gravity", T::Vector, "m/s²", "zero", "acceleration of every particle"},
    {"deck", "domain", T::Table, "", "required", "the box that bounds the particles"},
    {"deck", "time", T::Table, "", "required", "step and length of the run"},
    {"deck", "material", T::Tables, "", "required", "what particles and walls are made of"},
    {"deck", "pair", T::Tables, "", "none", "contact constants of two materials"},
    {"deck", "contact", T::Table, "", "none", "rules for all contacts"},
    {"deck", "bridge", T::Tables, "", "none", "liquid between touching particles"},
    {"deck", "bond", T::Tables, "", "none", "laws of linking elements"},
    {"deck", "heat", T::Table, "", "none", "gives particles temperatures, and lets heat flow"},
    {"deck", "particles", T::Tables, "", "required", "where particles come from"},
    {"deck", "wall", T::Tables, "", "none", "planes and plates"},
    {"deck", "stage", T::Tables, "", "one stage", "stages of the run, in order"},
    {"deck", "search", T::Table, "", "none", "how contacts are found"},
    {"deck", "exchange", T::Table, "", "none", "how ranks exchange halos"},
    {"deck", "limits", T::Table, "", "none", "overlaps beyond which a run warns or ends"},
    {"deck", "output", T::Table, "", "none", "what a run writes, and how often"},
    {"deck", "checkpoint", T::Table, "", "none", "when a run saves its state"},

    {"[domain]", "lo", T::Vector, "m", "required", "lower corner"},
    {"[domain]", "hi", T::Vector, "m", "required", "upper corner, above `lo` on every axis"},
    {"[domain]", "periodic", T::Names, "", "none", "axes that wrap around, such as `[\"x\"]`"},
    {"[domain]", "strip_axis", T::Choice, "", "longest", "axis along which ranks own strips",
     "x|y|z|longest"},
    {"[domain]", "cuts", T::Cuts, "", "auto",
     "how ranks share the domain: in the way with the smallest predicted step, as strips, or as "
     "bricks, a number along each axis, such as `[2, 2, 1]`"},
    {"[domain]", "outside", T::Choice, "", "error",
     "what happens when a particle leaves: the run ends, the particle is taken out, or all axes "
     "wrap around",
     "error|delete|periodic"},

    {"[time]", "step", T::PositiveNumber, "s", "required", "time step"},
    {"[time]", "end", T::PositiveNumber, "s", "none",
     "length of the run, rounded to whole steps; this or `steps`"},
    {"[time]", "steps", T::NonNegativeInteger, "", "none", "number of steps; this or `end`"},
    {"[time]", "allow_unstable", T::Boolean, "", "false",
     "run even if the step is beyond the stable one"},

    {"[[stage]]", "name", T::String, "", "required", "unique"},
    {"[[stage]]", "local_damping", T::Fraction, "", "0",
     "Cundall's alpha: each component of force is reduced by this share of itself, against the "
     "motion"},
    {"[[stage]]", "max_time", T::PositiveNumber, "s", "none",
     "the stage ends after this time at the latest"},
    {"[[stage]]", "kinetic_ratio", T::NonNegativeNumber, "", "0",
     "the stage ends when kinetic over elastic energy falls below this; 0 = never"},

    {"[heat]", "temperature", T::NonNegativeNumber, "K", "293.15",
     "at the start, of particles that say nothing else"},
    {"[heat]", "dissipation", T::Boolean, "", "false",
     "what dashpots, sliding and rolling take in contacts warms the particles: half of it each, at "
     "a wall all of it the particle"},

    {"[search]", "kind", T::Choice, "", "cells",
     "`cells` with lists of candidates, or every pair with every other, as a reference",
     "cells|all-pairs"},
    {"[search]", "skin", T::NonNegativeNumber, "m", "from the radii and speeds, then tuned",
     "gap up to which a pair is kept as a candidate"},

    {"[exchange]", "depth", T::NonNegativeInteger, "slabs", "0",
     "beyond each cut between ranks, which a rank steps, too, so that halos may come as many steps "
     "late; the layers of cells along the strip axis count; no bit depends on it"},

    {"[limits]", "overlap_warning", T::NonNegativeNumber, "", "0.5",
     "share of the smaller radius; a larger overlap gives one warning; 0 = never"},
    {"[limits]", "overlap_error", T::NonNegativeNumber, "", "1",
     "share of the smaller radius; a larger overlap ends the run; 0 = never"},

    {"[output]", "series_every", T::NonNegativeInteger, "steps", "0",
     "between rows of `series.csv`; 0 = a hundredth of the run"},
    {"[output]", "snapshots_every", T::NonNegativeInteger, "steps", "0",
     "between snapshots; 0 = only the first and the last state"},
    {"[output]", "picture", T::Boolean, "", "true", "draw the last state as `picture.png`"},
    {"[output]", "energy", T::Boolean, "", "false",
     "keep an account of where energy comes from and goes, in `series.csv`"},

    {"[checkpoint]", "every_steps", T::NonNegativeInteger, "steps", "0",
     "between checkpoints; 0 = not by steps"},
    {"[checkpoint]", "every_seconds", T::NonNegativeNumber, "s", "0",
     "of wall-clock time between checkpoints; 0 = not by time"},
    {"[checkpoint]", "keep", T::PositiveInteger, "", "2",
     "number of checkpoints to keep, the newest ones"},
};

}  // namespace

std::span<const KeySpec> run_keys() {
  return kRunKeys;
}

}  // namespace barchan::deck
