#include <barchan/core/laws/jkr.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <barchan/core/laws/mixing.hpp>
#include <barchan/core/simd/scalar.hpp>

namespace barchan {
namespace {

using Pair = Jkr::Pair;
using std::numbers::pi;

/// Of E* [m]: what a pair without surface energy gets, so that one formula serves all. The radius
/// without load is smaller than an atom then.
constexpr double kNone = 1e-36;

double energy_of(const Pair& p) {
  return std::max(p.surface_energy, kNone * p.young_star);
}

/// (9·pi·g/E*)^(1/3)
double adhesion_of(const Pair& p) {
  return std::cbrt(9.0 * pi * energy_of(p) / p.young_star);
}

}  // namespace

const std::array<LawKey, 1> Jkr::kMoreKeys{{
    {"surface_energy", LawKey::Range::NotNegative, "J/m²", "0",
     "gamma: contacts pull with 4·pi·gamma·R (`contact.adhesion = \"dmt\"`) or with 3·pi·gamma·R "
     "at most (`contact.model = \"jkr\"`)",
     [](Pair& p, double value) { p.surface_energy = value; }},
}};

std::optional<Pair> Jkr::mix(const Pair& a, const Pair& b) {
  auto p = HertzMindlin::mix(a, b);
  if (p) p->surface_energy = geometric_mean(a.surface_energy, b.surface_energy);
  return p;
}

std::array<std::string, 5> Jkr::texts(const Pair& p) {
  const auto hertz = HertzMindlin::texts(p);
  return {hertz[0], hertz[1], hertz[2], hertz[3], fmt::format("{:.4g}", p.surface_energy)};
}

// The pull of the surfaces is sqrt(12·pi·g·R·F) under a load F, less than half of the sum.
double Jkr::largest_force(const Pair& p, double share, double overlap, const Impact& impact) {
  const double hertz = HertzMindlin::largest_force(p, share, overlap, impact);
  return 1.5 * hertz + (1.0 + p.mu) * share * 6.0 * pi * energy_of(p) * impact.radius;
}

double Jkr::hold(const ContactRules& rules) {
  return rules.pull_off == PullOff::Limit ? kLeast : kPeak;
}

double Jkr::range(const Pair& p, const ContactRules& rules, double radius) {
  if (!acts(p) || p.surface_energy == 0.0) return 0.0;
  const double c = adhesion_of(p);
  return -hold(rules) * c * c * std::cbrt(radius);
}

void Jkr::write(const Pair& p, const ContactRules& rules, double* row) {
  HertzMindlin::write(p, rules, row);
  row[Adhesion] = acts(p) ? adhesion_of(p) : 1.0;
  row[Pull] = acts(p) ? 12.0 * pi * energy_of(p) : 0.0;
  row[Hold] = hold(rules);
}

// A contact that has come beyond the limit in the last step ends in the next one.
Jkr::Circle Jkr::circle(const double* row, const Overlap& overlap) {
  const double r = cube_root<simd::Scalar>(1.0 / overlap.inverse_radius),
               a0 = row[Adhesion] * r * r;
  const double load = overlap.depth / (overlap.inverse_radius * a0 * a0);
  return {a0, root<simd::Scalar>(std::max(load, kLeast + 1e-12))};
}

double Jkr::area(const double* row, const Overlap& overlap) {
  const auto [a0, s] = circle(row, overlap);
  return a0 * a0 * s * s * s * s;
}

double Jkr::tangential_stiffness(const double* row, const Overlap& overlap) {
  return row[Kt] * std::sqrt(area(row, overlap));
}

// From the surfaces apart; where a contact begins or ends, the difference is lost.
double Jkr::energy(const double* row, const History& /*history*/, const Overlap& overlap,
                   const double* numbers) {
  if (row[Pull] == 0.0) return 0.0;
  const auto [a0, s] = circle(row, overlap);
  const double s3 = s * s * s, s4 = s3 * s;
  const double normal = row[Pull] * a0 * a0 * s4 * (0.4 * s3 * s3 - 2.0 / 3.0 * s3 + 1.0 / 6.0);
  if (row[Kt] == 0.0) return normal;
  const double f2 = numbers[0] * numbers[0] + numbers[1] * numbers[1] + numbers[2] * numbers[2];
  return normal + 0.5 * f2 / (row[Kt] * a0 * s * s);
}

}  // namespace barchan
