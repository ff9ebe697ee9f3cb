#include <barchan/core/model/validate.hpp>

#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

constexpr int kMostKept = 1000;

/// Throws ModelFault.
void require(bool is_so, const std::string& key, const std::string& what,
             const std::string& remedy) {
  if (!is_so) throw ModelFault{key, what, remedy};
}

std::string_view last_of(const std::string& key) {
  return std::string_view(key).substr(key.find_last_of('.') + 1);
}

void positive(const std::string& key, double value) {
  require(std::isfinite(value) && value > 0.0, key, fmt::format("{} = {:g}", last_of(key), value),
          "give a number above zero");
}

void not_negative(const std::string& key, double value) {
  require(std::isfinite(value) && value >= 0.0, key, fmt::format("{} = {:g}", last_of(key), value),
          "give zero or more");
}

/// May be infinite, for never.
void positive_or_never(const std::string& key, double value) {
  require(value > 0.0, key, fmt::format("{} = {:g}", last_of(key), value),
          "give a number above zero, or infinity for never");
}

/// Finite, and in 2D within the plane.
void vector(const std::string& key, const Vec3& v, int dimension) {
  require(v.allFinite(), key, fmt::format("{} is not finite", last_of(key)), "give finite numbers");
  require(dimension == 3 || v.z() == 0.0, key,
          fmt::format("{} has a third component, {:g}, in 2D", last_of(key), v.z()),
          "leave it zero");
}

void check_domain(const Model& model) {
  const Domain& domain = model.domain;
  for (int axis = 0; axis < model.dimension; ++axis) {
    require(std::isfinite(domain.lo[axis]) && std::isfinite(domain.hi[axis]) &&
                domain.hi[axis] > domain.lo[axis],
            "domain.hi",
            fmt::format("the domain is empty: along {} hi = {:g} is not above lo = {:g}",
                        "xyz"[axis], domain.hi[axis], domain.lo[axis]),
            "give the lower corner as lo, the upper as hi");
  }
  require(domain.strip_axis >= 0 && domain.strip_axis < model.dimension, "domain.strip_axis",
          fmt::format("strip_axis = {} in {} dimensions", domain.strip_axis, model.dimension),
          "axes count from 0");
}

/// The constants of two materials, given in either order.
void check_pair(const Model& model, std::size_t a, std::size_t b, const std::string& key) {
  const std::size_t n = model.materials.size();
  const auto& constants = model.contacts.constants;
  with_law(model.contacts.law, [&]<class Law>(Law /*law*/) {
    const typename Law::Pair &pair = constants[a * n + b], &mirror = constants[b * n + a];
    std::vector<double> there, back;
    Law::for_each_number(pair, [&](const char* of, double value) {
      not_negative(key + of, value);
      there.push_back(value);
    });
    Law::for_each_number(mirror, [&](const char* /*of*/, double value) { back.push_back(value); });
    require(there == back, key + "name",
            fmt::format("contacts of materials {} and {} differ from those of {} and {}", a + 1,
                        b + 1, b + 1, a + 1),
            "ContactTable is symmetric");
  });
}

void check_contacts(const Model& model) {
  const std::size_t n = model.materials.size();
  require(n >= 1 && n <= kMostMaterials, "material", fmt::format("{} materials", n),
          fmt::format("give 1 to {}", kMostMaterials));
  const ContactTable& table = model.contacts;
  require(table.num_materials == static_cast<int>(n) && table.constants.size() == n * n, "material",
          fmt::format("contacts of {} materials with {} entries for {} materials",
                      table.num_materials, table.constants.size(), n),
          "ContactTable has num_materials² entries");
  require(table.law >= 0 && table.law < Laws::kSize, "contact",
          fmt::format("contacts by law number {}", table.law),
          fmt::format("there are {}, which count from 0", Laws::kSize));
  if (const auto fault = find_law_fault(table.law, table.twisting, model.dimension)) throw *fault;
  if (table.reference_speed) positive("contact.reference_speed", *table.reference_speed);
  for (std::size_t a = 0; a < n; ++a) {
    const std::string key = fmt::format("material.{}.", a + 1);
    positive(key + "density", model.materials[a].density);
    for (std::size_t b = 0; b < n; ++b) check_pair(model, a, b, key);
  }
}

void check_heat(const Model& model) {
  if (!model.heat.is_on) return;
  not_negative("heat.temperature", model.heat.temperature);
  for (std::size_t a = 0; a < model.materials.size(); ++a) {
    const std::string key = fmt::format("material.{}.", a + 1);
    not_negative(key + "conductivity", model.materials[a].conductivity);
    not_negative(key + "heat_capacity", model.materials[a].heat_capacity);
  }
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    const WallSpec& wall = model.walls[w];
    const std::string key = fmt::format("wall.{}.", w + 1);
    if (wall.temperature) not_negative(key + "temperature", *wall.temperature);
    const double flux = wall.heat_flux.value_or(0.0);
    require(std::isfinite(flux), key + "heat_flux", fmt::format("heat_flux = {:g}", flux),
            "give a finite number");
    require(!(wall.temperature && wall.heat_flux), key + "heat_flux",
            fmt::format("wall '{}' has both a temperature and a heat_flux", wall.name),
            "keep one of them");
  }
}

void check_bonds(const Model& model) {
  for (std::size_t b = 0; b < model.bond_laws.size(); ++b) {
    const BondLaw& law = model.bond_laws[b];
    const std::string key = fmt::format("bond.{}.", b + 1);
    not_negative(key + "young_modulus", law.young_modulus);
    not_negative(key + "normal_stiffness", law.normal_stiffness);
    require(law.young_modulus > 0.0 || law.normal_stiffness > 0.0, key + "name",
            fmt::format("bond '{}' has no stiffness", law.name),
            "add young_modulus in Pa or normal_stiffness in Pa/m");
    positive(key + "stiffness_ratio", law.stiffness_ratio);
    positive(key + "radius_factor", law.radius_factor);
    not_negative(key + "damping_ratio", law.damping_ratio);
    positive_or_never(key + "tensile_strength", law.tensile_strength);
    positive_or_never(key + "shear_strength", law.shear_strength);
  }
}

void check_plate(const Model& model, const WallSpec& wall, const std::string& key) {
  if (wall.kind == WallKind::Plane) {
    require(!wall.is_loaded, key + "load", "load on a plane", "only a plate carries a load");
    return;
  }
  positive(key + "width", wall.width);
  if (model.dimension == 3) positive(key + "depth", wall.depth);
  if (!wall.is_loaded) return;
  require(std::isfinite(wall.load), key + "load", fmt::format("load = {:g}", wall.load),
          "give a finite number");
  positive(key + "mass", wall.mass);
  not_negative(key + "damping", wall.damping);
}

/// A period must map a plane onto itself.
void check_plane(const Model& model, const WallSpec& wall, const std::string& key) {
  constexpr double kRounding = 1e-12;  // of a unit normal
  for (int axis = 0; axis < model.dimension && wall.kind == WallKind::Plane; ++axis) {
    const bool is_across = model.domain.periodic[static_cast<std::size_t>(axis)] &&
                           std::abs(wall.normal[axis]) > kRounding;
    require(!is_across, key + "normal",
            fmt::format("the plane '{}' lies across the periodic axis {}: one period further it "
                        "would be another plane",
                        wall.name, "xyz"[axis]),
            fmt::format("give it a normal with {0} = 0, write kind = \"plate\" with a width, or "
                        "take {0} out of domain.periodic",
                        "xyz"[axis]));
  }
}

void check_walls(const Model& model) {
  constexpr double kSlack = 1e-9;
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    const WallSpec& wall = model.walls[w];
    const std::string key = fmt::format("wall.{}.", w + 1);
    vector(key + "point", wall.point, model.dimension);
    vector(key + "velocity", wall.velocity, model.dimension);
    vector(key + "normal", wall.normal, model.dimension);
    require(std::abs(wall.normal.norm() - 1.0) <= kSlack, key + "normal",
            fmt::format("the normal of wall '{}' is {:g} long", wall.name, wall.normal.norm()),
            "give a unit vector, from the wall to the particles");
    require(wall.material >= 0 && wall.material < static_cast<int>(model.materials.size()),
            key + "material", fmt::format("wall '{}' is of material {}", wall.name, wall.material),
            fmt::format("there are {}, which count from 0", model.materials.size()));
    require(wall.from_stage >= 0 && wall.from_stage < static_cast<int>(model.stages.size()),
            key + "from_stage",
            fmt::format("wall '{}' appears at stage {}", wall.name, wall.from_stage),
            fmt::format("there are {}, which count from 0", model.stages.size()));
    check_plate(model, wall, key);
    check_plane(model, wall, key);
  }
}

void check_stages(const Model& model) {
  require(!model.stages.empty(), "stage", "there are no stages", "give at least one Stage");
  for (std::size_t s = 0; s < model.stages.size(); ++s) {
    const Stage& stage = model.stages[s];
    const std::string key = fmt::format("stage.{}.", s + 1);
    require(stage.local_damping >= 0.0 && stage.local_damping <= 1.0, key + "local_damping",
            fmt::format("local_damping = {:g}", stage.local_damping), "give a number in [0, 1]");
    positive_or_never(key + "max_time", stage.max_time);
    not_negative(key + "kinetic_ratio", stage.kinetic_ratio);
    const bool ends = std::isfinite(stage.max_time) || stage.kinetic_ratio > 0.0;
    require(ends || s + 1 == model.stages.size(), key + "name",
            fmt::format("stage '{}' never ends, so those after it never begin", stage.name),
            "give it max_time or kinetic_ratio");
  }
}

void check_limits(const LimitSpec& limits) {
  positive_or_never("limits.overlap_warning", limits.overlap_warning);
  positive_or_never("limits.overlap_error", limits.overlap_error);
  require(std::isinf(limits.overlap_warning) || limits.overlap_warning <= limits.overlap_error,
          "limits.overlap_warning",
          fmt::format("overlap_warning = {:g} is beyond overlap_error = {:g}",
                      limits.overlap_warning, limits.overlap_error),
          "choose a smaller one, or overlap_warning = 0 for no warning");
}

void check_counts(const Model& model) {
  const auto count = [](const char* key, std::int64_t value) {
    require(value >= 0, key, fmt::format("{} = {}", last_of(key), value), "give zero or more");
  };
  count("time.steps", model.time.num_steps);
  count("output.series_every", model.output.series_every);
  count("output.snapshots_every", model.output.snapshots_every);
  count("checkpoint.every_steps", model.checkpoint.every_steps);
}

void check_saving(const CheckpointSpec& spec) {
  require(spec.every_steps >= 0, "checkpoint.every_steps",
          fmt::format("every_steps = {}", spec.every_steps), "give zero or more");
  not_negative("checkpoint.every_seconds", spec.every_seconds);
  require(spec.keep >= 1 && spec.keep <= kMostKept, "checkpoint.keep",
          fmt::format("keep = {} is out of range", spec.keep),
          fmt::format("keep 1 to {}", kMostKept));
}

void check(const Model& model) {
  require(model.dimension == 2 || model.dimension == 3, "dimension",
          fmt::format("dimension = {}", model.dimension), "give 2 for disks or 3 for spheres");
  check_domain(model);
  positive("time.step", model.time.step);
  vector("gravity", model.gravity, model.dimension);
  check_contacts(model);
  check_bonds(model);
  check_stages(model);
  check_walls(model);
  check_heat(model);
  if (model.search.skin) not_negative("search.skin", *model.search.skin);
  check_limits(model.limits);
  check_counts(model);
  check_saving(model.checkpoint);
}

[[noreturn]] void refuse(const ModelFault& fault) {
  throw InputError(fault.key + ": " + fault.what, fault.remedy);
}

}  // namespace

std::optional<ModelFault> find_law_fault(int law, bool twisting, int dimension) {
  return with_law(law, [&]<class Law>(Law /*law*/) -> std::optional<ModelFault> {
    if (dimension == 2 && twisting)
      return ModelFault{"contact.twisting", "twisting in 2D: disks turn about the third axis alone",
                        "leave it out, or write dimension = 3 for spheres"};
    if (dimension == 3 || Law::kIsForDisks) return std::nullopt;
    return ModelFault{"contact.model",
                      fmt::format("contact.model = \"{}\" in 2D: a disk of unit thickness touches "
                                  "along a line, for which there is no Hertz law",
                                  Law::kName),
                      "write model = \"linear\", or dimension = 3 for spheres"};
  });
}

std::optional<ModelFault> find_fault(const Model& model) {
  try {
    check(model);
  } catch (const ModelFault& fault) {
    return fault;
  }
  return std::nullopt;
}

void validate(const Model& model) {
  if (const auto fault = find_fault(model)) refuse(*fault);
}

void validate(const CheckpointSpec& spec) {
  try {
    check_saving(spec);
  } catch (const ModelFault& fault) {
    refuse(fault);
  }
}

}  // namespace barchan
