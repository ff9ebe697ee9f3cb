#include <barchan/core/laws/hertz_mindlin.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <barchan/core/laws/mixing.hpp>
#include <barchan/core/laws/restitution.hpp>
#include <barchan/core/laws/stable_step.hpp>

namespace barchan {
namespace {

using Pair = HertzMindlin::Pair;
using Range = LawKey::Range;

/// (1 − nu²)/E and (2 − nu)/G of a material [1/Pa].
double normal_compliance(const Pair& m) {
  const double nu = m.poisson_ratio.value_or(0.0);
  return m.is_rigid ? 0.0 : (1.0 - nu * nu) / m.young_modulus;
}
double shear_compliance(const Pair& m) {
  const double nu = m.poisson_ratio.value_or(0.0);
  return m.is_rigid ? 0.0 : (2.0 - nu) * 2.0 * (1.0 + nu) / m.young_modulus;
}

/// 4/3·E*·a at an overlap [N/m]: the force over the overlap.
double secant(const Pair& p, double radius, double overlap) {
  return 4.0 / 3.0 * p.young_star * std::sqrt(radius * overlap);
}

}  // namespace

const std::array<LawKey, HertzMindlin::kNumKeys> HertzMindlin::kKeys{{
    {"young_modulus", Range::Positive, "Pa", "none",
     "E; hertz contacts require it, and linear ones with `contact.stiffness = \"radius\"`",
     [](Pair& p, double value) { p.young_modulus = value; }, -1, true},
    {"poisson_ratio", Range::Poisson, "", "none", "beside `young_modulus`",
     [](Pair& p, double value) { p.poisson_ratio = value; }, -1, true},
    {"rigid", Range::Flag, "", "false", "of walls only, instead of `young_modulus`: 1/E = 0",
     [](Pair& p, double value) { p.is_rigid = value != 0.0; }, -1, true},
    {"restitution", Range::Restitution, "", "none", "",
     [](Pair& p, double value) { p.restitution = value; }},
    {"friction", Range::NotNegative, "", "0", "", [](Pair& p, double value) { p.mu = value; }},
    {"tangential_damping_ratio", Range::NotNegative, "", "1",
     "tangential over normal dashpot of hertz contacts",
     [](Pair& p, double value) { p.tangential_ratio = value; }},
}};

std::optional<KeyGap> HertzMindlin::find_gap(const Pair& material) {
  if (material.is_rigid) {
    if (material.young_modulus == 0.0 && !material.poisson_ratio) return std::nullopt;
    return KeyGap{"beside rigid = true", "keep rigid, or young_modulus and poisson_ratio"};
  }
  if (!(material.young_modulus > 0.0))
    return KeyGap{"without young_modulus",
                  "add young_modulus in Pa and poisson_ratio, or, for walls, rigid = true"};
  if (!material.poisson_ratio)
    return KeyGap{"without poisson_ratio",
                  "add poisson_ratio, a number in (-1, 0.5]; glass has 0.22, steel 0.29"};
  return std::nullopt;
}

std::optional<Pair> HertzMindlin::mix(const Pair& a, const Pair& b) {
  Pair p;
  const double normal = normal_compliance(a) + normal_compliance(b);
  p.young_star = normal > 0.0 ? 1.0 / normal : 0.0;  // two rigid ones never meet
  p.shear_star = normal > 0.0 ? 1.0 / (shear_compliance(a) + shear_compliance(b)) : 0.0;
  if (a.young_modulus == b.young_modulus && a.poisson_ratio == b.poisson_ratio) {
    p.young_modulus = a.young_modulus;
    p.poisson_ratio = a.poisson_ratio;
  }
  p.mu = std::min(a.mu, b.mu);
  if (a.restitution && b.restitution)
    p.restitution = geometric_mean(*a.restitution, *b.restitution);
  p.tangential_ratio = geometric_mean(a.tangential_ratio, b.tangential_ratio);
  p.is_mixed = true;
  return p;
}

// With y = 4/5·x^(5/4) and x^(1/4)·dt as the clock, x'' = −x^(3/2) − alpha·x^(1/4)·x' becomes
// y'' = −5/4·y − alpha·y': a linear spring and dashpot with zeta = alpha/sqrt(5), whose force ends
// where that of the contact does.
void HertzMindlin::solve(Pair& p, const ContactRules& rules) {
  if (p.restitution) p.alpha = std::sqrt(5.0) * damping_ratio_for(*p.restitution, rules.no_tension);
}

std::array<std::string, 4> HertzMindlin::texts(const Pair& p) {
  return {fmt::format("{:.4g}", p.young_star), fmt::format("{:.4g}", p.shear_star),
          fmt::format("{:.4g}", p.alpha), fmt::format("{:.4g}", p.mu)};
}

double HertzMindlin::restitution(const Pair& p, double /*reduced_mass*/,
                                 const ContactRules& rules) {
  return p.restitution.value_or(restitution_at(p.alpha / std::sqrt(5.0), rules.no_tension));
}

std::string HertzMindlin::stiffer(double /*stiffness*/, double factor) {
  return fmt::format("young_modulus {:.2g} times as large", factor);
}

double HertzMindlin::pressed_overlap(const Pair& p, double radius, double force) {
  const double size = 0.75 * force / (p.young_star * std::sqrt(radius));
  return std::cbrt(size * size);
}

double HertzMindlin::struck_overlap(const Pair& p, const Impact& impact) {
  const double size = 15.0 / 16.0 * impact.mass * impact.speed * impact.speed /
                      (p.young_star * std::sqrt(impact.radius));
  return std::pow(size, 0.4);
}

double HertzMindlin::duration(const Pair& p, const Impact& impact) {
  constexpr double kTwoIntegrals = 2.943275;  // 2·∫ dx/sqrt(1 − x^(5/2)) from 0 to 1
  return kTwoIntegrals * struck_overlap(p, impact) / impact.speed;
}

double HertzMindlin::stiffness(const Pair& p, const Impact& impact) {
  return acts(p) ? 1.5 * secant(p, impact.radius, struck_overlap(p, impact)) : 0.0;
}

double HertzMindlin::dashpot(const Pair& p, const Impact& impact) {
  if (!acts(p)) return 0.0;
  return p.alpha * std::sqrt(impact.mass * secant(p, impact.radius, struck_overlap(p, impact)));
}

double HertzMindlin::wave_time(const Pair& m, double radius, double density) {
  if (!(m.young_modulus > 0.0) || !m.poisson_ratio) return 0.0;
  const double nu = *m.poisson_ratio, shear = 0.5 * m.young_modulus / (1.0 + nu);
  return std::numbers::pi * radius * std::sqrt(density / shear) / (0.1631 * nu + 0.8766);
}

double HertzMindlin::largest_force(const Pair& p, double share, double overlap,
                                   const Impact& impact) {
  const double k = secant(p, impact.radius, overlap);
  const double damping = p.alpha * std::sqrt(impact.mass * k);
  return (1.0 + p.mu) * std::max(share * k * overlap, damping * impact.speed);
}

// Without friction there is no tangential force: nothing is kept of one, either.
void HertzMindlin::write(const Pair& p, const ContactRules& rules, double* row) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const bool has_friction = p.mu > 0.0;
  row[Kn] = 4.0 / 3.0 * p.young_star;
  row[Kt] = has_friction ? 8.0 * p.shear_star : 0.0;
  row[Mu] = p.mu;
  row[Damping] = p.alpha * std::sqrt(row[Kn]);
  row[TangentialRatio] = has_friction ? p.tangential_ratio : 0.0;
  row[Cap] = rules.no_tension ? 0.0 : kInfinite;
  row[Growth] = rules.tangential == Tangential::Mindlin ? 1.0 : kInfinite;
}

double HertzMindlin::tangential_stiffness(const double* row, const Overlap& overlap) {
  return row[Kt] * std::sqrt(area(row, overlap));
}

double HertzMindlin::stable_step_of(const double* row, double area, double mass, double spin_gain) {
  const double a = std::sqrt(area), c = row[Damping] * std::sqrt(mass * a);
  const double normal = barchan::stable_step(mass, 1.5 * row[Kn] * a, c);
  if (row[Mu] == 0.0) return normal;
  return std::min(normal, barchan::stable_step(mass / (1.0 + spin_gain), row[Kt] * a,
                                               row[TangentialRatio] * c));
}

double HertzMindlin::energy(const double* row, const History& /*history*/, const Overlap& overlap,
                            const double* numbers) {
  const double a = std::sqrt(overlap.depth / overlap.inverse_radius);
  const double normal = 0.4 * row[Kn] * a * overlap.depth * overlap.depth;
  if (row[Kt] == 0.0) return normal;
  const double f2 = numbers[0] * numbers[0] + numbers[1] * numbers[1] + numbers[2] * numbers[2];
  return normal + 0.5 * f2 / (row[Kt] * a);
}

}  // namespace barchan
