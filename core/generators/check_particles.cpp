#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/base/vec_text.hpp>
#include <barchan/core/generators/close_pairs.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/core/model/mass.hpp>

namespace barchan {
namespace {

using PlaceOf = std::function<SourcePlace(std::size_t)>;

std::string at(const ParticleData& p, int dimension) {
  return fmt::format("particle {} at {}", p.id, in_brackets(p.position, dimension));
}

/// A temperature that is not given is that of the model.
template <class Refuse>
void check_heat(const Model& model, const ParticleData& p, const Refuse& refuse) {
  if (!std::isnan(p.temperature) && !(p.temperature >= 0.0 && std::isfinite(p.temperature)))
    refuse(fmt::format("has temperature {:g}", p.temperature), "give zero or more [K]");
  const Material& material = model.materials[static_cast<std::size_t>(p.type)];
  if (!(material.conductivity > 0.0) || !(material.heat_capacity > 0.0))
    refuse(fmt::format("is of '{}', which has no conductivity or no heat_capacity", material.name),
           "add both to the material");
}

void check_each(const Model& model, const ParticleData& p, std::size_t index,
                const PlaceOf& place_of) {
  const auto refuse = [&](const std::string& what, const char* remedy) {
    throw InputError(place_of(index), at(p, model.dimension) + " " + what, remedy);
  };
  const bool moves = !p.velocity.isZero(0.0) || !p.omega.isZero(0.0);
  if (p.fixed && moves)
    refuse("is fixed and has a velocity", "leave velocity and omega out: fixed particles stay");
  if (p.id < 1) refuse("has no valid id", "ids count from 1");
  if (!(p.position.allFinite() && p.velocity.allFinite() && p.omega.allFinite())) {
    refuse("has a position or velocity that is not finite", "give finite numbers");
  }
  const bool is_flat =
      p.position.z() == 0.0 && p.velocity.z() == 0.0 && p.omega.x() == 0.0 && p.omega.y() == 0.0;
  if (model.dimension == 2 && !is_flat)
    refuse("leaves the plane",
           "in 2D the third components of position and velocity are zero, and "
           "omega turns about z alone");
  if (!(p.radius > 0.0 && std::isfinite(p.radius)))
    refuse(fmt::format("has radius {:g}", p.radius), "a radius is above zero [m]");
  if (!(p.density > 0.0 && std::isfinite(p.density)))
    refuse(fmt::format("has density {:g}", p.density), "a density is above zero");
  const double mass = mass_of(p, model.dimension);
  if (!std::isfinite(mass) || !std::isfinite(1.0 / mass))
    refuse(fmt::format("has a mass of {:g} kg", mass), "other units keep it within numbers");
  if (p.type < 0 || p.type >= static_cast<std::int32_t>(model.materials.size())) {
    refuse(fmt::format("is of type {}", p.type + 1), "every type needs a material in the deck");
  }
  if (model.heat.is_on) check_heat(model, p, refuse);
  if (!is_inside(model.domain, p.position, model.dimension)) {
    refuse("is outside the domain", "enlarge the domain or leave the particle out");
  }
}

std::vector<std::int64_t> sorted_ids(const ParticleSet& set) {
  std::vector<std::int64_t> ids;
  ids.reserve(set.particles.size());
  for (const ParticleData& p : set.particles) ids.push_back(p.id);
  std::sort(ids.begin(), ids.end());
  const auto twin = std::adjacent_find(ids.begin(), ids.end());
  if (twin != ids.end())
    throw InputError(fmt::format("particle id {} appears twice", *twin),
                     "every id may appear once");
  return ids;
}

bool is_less(const BondData& a, const BondData& b) {
  return a.id_a != b.id_a ? a.id_a < b.id_a : a.id_b < b.id_b;
}

void check_bond(const Model& model, const BondData& bond, std::span<const std::int64_t> ids) {
  const auto refuse = [&](const char* what, const char* remedy) {
    throw InputError(
        fmt::format("the bond between particles {} and {} {}", bond.id_a, bond.id_b, what), remedy);
  };
  if (bond.id_a >= bond.id_b)
    refuse("is not in order", "the lower id comes first, and the two differ");
  const bool are_known = std::binary_search(ids.begin(), ids.end(), bond.id_a) &&
                         std::binary_search(ids.begin(), ids.end(), bond.id_b);
  if (!are_known) refuse("refers to an unknown particle", "both must exist");
  if (bond.law < 0 || bond.law >= static_cast<std::int32_t>(model.bond_laws.size()))
    refuse("is of an unknown law", "name a bond of the deck");
  if (!(bond.length >= 0.0 && std::isfinite(bond.length) && bond.shear.allFinite() &&
        bond.bending.allFinite() && std::isfinite(bond.twisting)))
    refuse("has a length or force that is not a number", "give finite ones, lengths above zero");
  const bool is_flat = bond.shear.y() == 0.0 && bond.shear.z() == 0.0 && bond.bending.x() == 0.0 &&
                       bond.bending.y() == 0.0 && bond.twisting == 0.0;
  if (model.dimension == 2 && !is_flat)
    refuse("leaves the plane", "in 2D it is sheared by a force in x and bent by a moment about z");
}

std::vector<BondData> checked_bonds(const Model& model, const ParticleSet& set,
                                    std::span<const std::int64_t> ids) {
  std::vector<BondData> bonds = set.bonds;
  for (const BondData& bond : bonds) check_bond(model, bond, ids);
  std::sort(bonds.begin(), bonds.end(), is_less);
  const auto twin = std::adjacent_find(
      bonds.begin(), bonds.end(),
      [](const BondData& a, const BondData& b) { return a.id_a == b.id_a && a.id_b == b.id_b; });
  if (twin != bonds.end()) {
    throw InputError(fmt::format("particles {} and {} are bonded twice", twin->id_a, twin->id_b),
                     "a pair has at most one bond");
  }
  return bonds;
}

/// Where the other of two is, without what both have in common.
std::string place_beside(const SourcePlace& other, const SourcePlace& place) {
  const bool is_same_file = other.file == place.file;
  if (other.file.empty() || (is_same_file && other.line == place.line)) return {};
  if (is_same_file) return fmt::format(" (line {})", other.line);
  return other.line > 0 ? fmt::format(" ({}:{})", other.file, other.line)
                        : fmt::format(" ({})", other.file);
}

[[noreturn]] void refuse_overlap(const Model& model, const ParticleSet& set, double overlap,
                                 std::size_t i, std::size_t j, const PlaceOf& place_of) {
  const ParticleData& a = set.particles[i];
  const ParticleData& b = set.particles[j];
  const SourcePlace second = place_of(j);
  const std::string first = place_beside(place_of(i), second);
  throw InputError(
      second,
      fmt::format("{} overlaps {}{} by {:.0f} % of the smaller radius", at(b, model.dimension),
                  at(a, model.dimension), first, 100.0 * overlap / std::min(a.radius, b.radius)),
      fmt::format("at most {:.0f} %: do the regions of two sources overlap?",
                  100.0 * kGrossOverlap));
}

void check_overlaps(const Model& model, const ParticleSet& set, std::span<const BondData> bonds,
                    const PlaceOf& place_of) {
  const std::vector<ParticleData>& particles = set.particles;
  std::vector<Grain> grains;
  grains.reserve(particles.size());
  for (const ParticleData& p : particles) grains.push_back({p.position, p.radius});
  const PairSpace space{model.dimension, model.domain.lo, model.domain.hi, model.domain.periodic};
  for_each_close_pair(space, grains, 0.0, [&](std::uint32_t i, std::uint32_t j) {
    const ParticleData& a = particles[i];
    const ParticleData& b = particles[j];
    const double overlap = a.radius + b.radius - space.difference(a.position, b.position).norm();
    const double smaller = std::min(a.radius, b.radius);
    if (overlap <= kGrossOverlap * smaller || (a.fixed && b.fixed)) return true;
    const BondData bond{std::min(a.id, b.id), std::max(a.id, b.id), 0};
    if (std::binary_search(bonds.begin(), bonds.end(), bond, is_less)) return true;
    refuse_overlap(model, set, overlap, std::min(i, j), std::max(i, j), place_of);
  });
}

}  // namespace

void check_particles(const Model& model, const ParticleSet& set, const PlaceOf& place_of) {
  if (!place_of) return check_particles(model, set, [](std::size_t) { return SourcePlace{}; });
  if (set.particles.empty())
    throw InputError(SourcePlace{model.deck_file, 0, 0}, "there are no particles",
                     "give at least one [[particles]] table");
  for (std::size_t i = 0; i < set.particles.size(); ++i)
    check_each(model, set.particles[i], i, place_of);
  const std::vector<std::int64_t> ids = sorted_ids(set);
  const std::vector<BondData> bonds = checked_bonds(model, set, ids);
  check_overlaps(model, set, bonds, place_of);
}

}  // namespace barchan
