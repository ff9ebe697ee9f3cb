#include <barchan/core/laws/hertz_adhesive.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <barchan/core/laws/mixing.hpp>

namespace barchan {
namespace {

using Pair = HertzAdhesive::Pair;
using Range = LawKey::Range;

constexpr double kPi = std::numbers::pi;

/// ∫ of the lens' (radius)² over the overlap, from touch to a distance d [m³].
double lens_integral(double reach, double radius, double d) {
  const double s = reach;
  if (2.0 * radius > s) return s * s * (s - d) - (s * s * s - d * d * d) / 3.0;
  const auto at = [&](double x) {
    return -x * x * x / 12.0 + (0.5 * s * s - radius * s) * x -
           (radius * s * s * s - 0.25 * s * s * s * s) / x;
  };
  return at(s) - at(d);
}

}  // namespace

const std::array<LawKey, 2> HertzAdhesive::kMoreKeys{{
    {"surface_energy", Range::NotNegative, "J/m²", "0",
     "gamma: contacts pull with 4·pi·gamma·R (`contact.adhesion = \"dmt\"`) or with 3·pi·gamma·R "
     "at most (`contact.model = \"jkr\"`)",
     [](Pair& p, double value) { p.surface_energy = value; }, -1, false, LawKey::Part::Dmt},
    {"cohesion_density", Range::NotNegative, "J/m³", "0",
     "contacts pull with it times their area; `contact.adhesion = \"sjkr\"` or `\"sjkr2\"`",
     [](Pair& p, double value) { p.cohesion_density = value; }, -1, false, LawKey::Part::Sjkr},
}};

std::optional<Pair> HertzAdhesive::mix(const Pair& a, const Pair& b) {
  auto p = HertzMindlin::mix(a, b);
  p->surface_energy = geometric_mean(a.surface_energy, b.surface_energy);
  p->cohesion_density = geometric_mean(a.cohesion_density, b.cohesion_density);
  return p;
}

std::array<std::string, 5> HertzAdhesive::texts(const Pair& p) {
  const auto base = HertzMindlin::texts(p);
  const std::string adhesion = p.surface_energy > 0.0
                                   ? fmt::format("{:.4g} J/m²", p.surface_energy)
                                   : fmt::format("{:.4g} J/m³", p.cohesion_density);
  return {base[0], base[1], base[2], base[3], adhesion};
}

double HertzAdhesive::largest_force(const Pair& p, double share, double overlap,
                                    const Impact& impact) {
  const double pull =
      4.0 * kPi * impact.radius * (p.surface_energy + 2.0 * p.cohesion_density * overlap);
  return HertzMindlin::largest_force(p, share, overlap, impact) + 2.0 * share * (1.0 + p.mu) * pull;
}

void HertzAdhesive::write(const Pair& p, const ContactRules& rules, double* row) {
  HertzMindlin::write(p, rules, row);
  const double kappa = p.cohesion_density;
  row[Pull] = rules.adhesion == Adhesion::Dmt ? 4.0 * kPi * p.surface_energy : 0.0;
  row[Lens] = rules.adhesion == Adhesion::Sjkr ? kPi * kappa : 0.0;
  row[Area] = rules.adhesion == Adhesion::Sjkr2 ? 4.0 * kPi * kappa : 0.0;
}

// Negative where a contact has pulled more than it pushed.
double HertzAdhesive::energy(const double* row, const History& history, const Overlap& overlap,
                             const double* numbers) {
  const double radius = 1.0 / overlap.inverse_radius, depth = overlap.depth;
  return HertzMindlin::energy(row, history, overlap, numbers) - row[Pull] * radius * depth -
         0.5 * row[Area] * radius * depth * depth -
         row[Lens] * lens_integral(overlap.reach, radius, overlap.reach - depth);
}

}  // namespace barchan
