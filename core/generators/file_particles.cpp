#include <barchan/core/generators/file_particles.hpp>

#include <cmath>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/particle_columns.hpp>

namespace barchan {
namespace {

constexpr double kSameBox = 1e-9;  // of the domain's length

void take_laws(const Model& model, const ParticleSource& source, ParticleFile& file) {
  const auto num_laws = static_cast<std::int32_t>(model.bond_laws.size());
  for (BondData& bond : file.bonds) {
    if (source.bond) bond.law = *source.bond;
    if (bond.law < num_laws) continue;
    throw InputError(SourcePlace{file.file, 0, 0},
                     fmt::format("the bond between particles {} and {} is of type {}", bond.id_a,
                                 bond.id_b, bond.law + 1),
                     fmt::format("the deck has {} [[bond]] table{}; or name one for all bonds of "
                                 "the file by bond = \"...\" in [[particles]]",
                                 num_laws, num_laws == 1 ? "" : "s"));
  }
}

std::string in_words(const Vec3& lo, const Vec3& hi, int dimension) {
  std::string text;
  for (int axis = 0; axis < dimension; ++axis)
    text += fmt::format("{}{:.6g} … {:.6g}", axis == 0 ? "" : " × ", lo[axis], hi[axis]);
  return text + " m";
}

/// What differs between the file's box and the domain, in words; empty where they are the same.
std::string compare_boxes(const Model& model, const Box& box) {
  const Domain& domain = model.domain;
  std::string wrapped;
  bool is_same = true;
  for (int axis = 0; axis < model.dimension; ++axis) {
    const double length = domain.hi[axis] - domain.lo[axis];
    const double at_lo = std::fabs(box.lo[axis] - domain.lo[axis]);
    const double at_hi = std::fabs(box.hi[axis] - domain.hi[axis]);
    if (at_lo <= kSameBox * length && at_hi <= kSameBox * length) continue;
    is_same = false;
    const bool is_as_long = std::fabs(box.hi[axis] - box.lo[axis] - length) <= kSameBox * length;
    if (domain.periodic[static_cast<std::size_t>(axis)] && !is_as_long)
      wrapped += fmt::format(
          "; along {}, which is periodic, particles get other neighbours across "
          "the faces",
          "xyz"[axis]);
  }
  if (is_same) return {};
  return fmt::format("its box is {}, the domain {}{}", in_words(box.lo, box.hi, model.dimension),
                     in_words(domain.lo, domain.hi, model.dimension), wrapped);
}

}  // namespace

ParticleFile read_source(const Model& model, const ParticleSource& source, const FileSource& kind) {
  ParticleFile file = read_particles(kind.path);
  if (!kind.has_sphere_density) file.has_sphere_density = false;
  if (model.dimension == 2) convert_to_areal_density(file);
  if (!file.has_bonds) return file;
  if (source.links.gap)
    throw InputError(source.links.place, "bond_gap for a file that has bonds of its own",
                     "leave bond_gap out, or take the bonds out of the file");
  if (source.bond && file.bonds.empty() && source.links.pairs.empty())
    throw InputError(source.links.place, "the file says that there are no bonds",
                     "leave bond out, or give bond_pairs");
  take_laws(model, source, file);
  return file;
}

std::vector<std::string> notes_on(const Model& model, const ParticleFile& file) {
  std::vector<std::string> notes;
  for (const std::string& note : file.notes) notes.push_back(file.file + ": " + note);
  const std::string boxes = file.box ? compare_boxes(model, *file.box) : "";
  if (have_heat(file.particles) && !model.heat.is_on)
    notes.push_back(file.file + ": temperatures are not used: the deck has no [heat]");
  if (!boxes.empty()) notes.push_back(file.file + ": " + boxes);
  return notes;
}

}  // namespace barchan
