#include <barchan/core/laws/linear_by_radius.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <barchan/core/laws/mixing.hpp>
#include <barchan/core/laws/restitution.hpp>

namespace barchan {

using Pair = LinearByRadius::Pair;
using Range = LawKey::Range;

const std::array<LawKey, LinearByRadius::kNumKeys> LinearByRadius::kKeys{{
    {"young_modulus", Range::Positive, "Pa", "none", "",
     [](Pair& p, double value) { p.young_modulus = value; }, -1, true},
    {"tangential_stiffness_ratio", Range::NotNegative, "", "2/7",
     "tangential over normal spring; `contact.stiffness = \"radius\"`",
     [](Pair& p, double value) { p.kt_ratio = value; }},
    {"restitution", Range::Restitution, "", "none", "",
     [](Pair& p, double value) { p.restitution = value; }},
    {"friction", Range::NotNegative, "", "0", "", [](Pair& p, double value) { p.mu = value; }},
    {"tangential_damping_ratio", Range::NotNegative, "", "1", "",
     [](Pair& p, double value) { p.tangential_ratio = value; }},
}};

std::optional<KeyGap> LinearByRadius::find_gap(const Pair& material) {
  if (material.young_modulus > 0.0) return std::nullopt;
  return KeyGap{"without young_modulus",
                "add young_modulus in Pa to the material; springs follow from it and the radii"};
}

std::optional<Pair> LinearByRadius::mix(const Pair& a, const Pair& b) {
  Pair p;
  p.young_star = in_series(a.young_modulus, b.young_modulus);
  p.mu = std::min(a.mu, b.mu);
  p.kt_ratio = geometric_mean(a.kt_ratio, b.kt_ratio);
  if (a.restitution && b.restitution)
    p.restitution = geometric_mean(*a.restitution, *b.restitution);
  p.tangential_ratio = geometric_mean(a.tangential_ratio, b.tangential_ratio);
  p.is_mixed = true;
  return p;
}

void LinearByRadius::solve(Pair& p, const ContactRules& rules) {
  if (!p.restitution) return;
  p.cn.critical =
      2.0 * damping_ratio_for(*p.restitution, rules.no_tension) * std::sqrt(2.0 * p.young_star);
}

std::array<std::string, 5> LinearByRadius::texts(const Pair& p) {
  return {fmt::format("{:.4g}", p.young_star), fmt::format("{:.4g}", p.kt_ratio),
          fmt::format("{:.4g} · √(m·R)", p.cn.critical), fmt::format("{:.4g}", p.tangential_ratio),
          fmt::format("{:.4g}", p.mu)};
}

std::string LinearByRadius::stiffer(double /*stiffness*/, double factor) {
  return fmt::format("young_modulus {:.2g} times as large", factor);
}

Pair LinearByRadius::at(const Pair& p, double radius) {
  Pair here = p;
  here.kn = 2.0 * p.young_star * radius;
  here.kt = p.kt_ratio * here.kn;
  here.cn.critical = p.cn.critical * std::sqrt(radius);
  here.ct.critical = p.tangential_ratio * here.cn.critical;
  return here;
}

void LinearByRadius::write(const Pair& p, const ContactRules& rules, double* row) {
  const Pair unit = at(p, 1.0);
  row[Kn] = unit.kn;
  row[Kt] = unit.kt;
  row[InverseKt] = unit.kt > 0.0 ? 1.0 / unit.kt : 0.0;
  row[Mu] = p.mu;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  row[Cap] = rules.no_tension ? 0.0 : kNever;
  row[Cn] = p.cn.critical;
  row[TangentialRatio] = p.tangential_ratio;
}

}  // namespace barchan
