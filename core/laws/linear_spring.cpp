#include <barchan/core/laws/linear_spring.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <barchan/core/laws/mixing.hpp>
#include <barchan/core/laws/restitution.hpp>

namespace barchan {
namespace {

using Pair = LinearSpring::Pair;
using Range = LawKey::Range;

bool is_zero(const Dashpot& dashpot) {
  return dashpot.constant == 0.0 && dashpot.rate == 0.0 && dashpot.critical == 0.0;
}

/// None when both damp, but in ways that do not add up.
std::optional<Dashpot> dashpots_in_series(const Dashpot& a, const Dashpot& b) {
  const Dashpot mixed{in_series(a.constant, b.constant), in_series(a.rate, b.rate),
                      in_series(a.critical, b.critical)};
  if (is_zero(mixed) && !is_zero(a) && !is_zero(b)) return std::nullopt;
  return mixed;
}

std::string text_of(const Dashpot& d) {
  if (d.rate > 0.0) return fmt::format("{:.4g} · m/s", d.rate);
  if (d.critical > 0.0) return fmt::format("{:.4g} · √m", d.critical);
  return fmt::format("{:.4g}", d.constant);
}

}  // namespace

const std::array<LawKey, LinearSpring::kNumKeys> LinearSpring::kKeys{{
    {"normal_stiffness", Range::Positive, "N/m", "none",
     "normal spring; linear contacts require it", [](Pair& p, double value) { p.kn = value; }},
    {"tangential_stiffness", Range::NotNegative, "N/m", "0", "tangential spring",
     [](Pair& p, double value) { p.kt = value; }},
    {"normal_damping", Range::NotNegative, "N·s/m", "0", "dashpot coefficient",
     [](Pair& p, double value) { p.cn.constant = value; }},
    {"normal_damping_rate", Range::NotNegative, "1/s", "none",
     "dashpot coefficient per effective mass of the pair, instead of `normal_damping`",
     [](Pair& p, double value) { p.cn.rate = value; }, 2},
    {"restitution", Range::Restitution, "", "none",
     "ratio of normal speeds after and before a collision; linear: instead of `normal_damping`, "
     "hertz: "
     "required",
     [](Pair& p, double value) { p.restitution = value; }, 2},
    {"tangential_damping", Range::NotNegative, "N·s/m", "0", "tangential dashpot",
     [](Pair& p, double value) { p.ct.constant = value; }},
    {"tangential_damping_rate", Range::NotNegative, "1/s", "none",
     "per effective mass of the pair, instead of `tangential_damping`",
     [](Pair& p, double value) { p.ct.rate = value; }, 5},
    {"friction", Range::NotNegative, "", "0", "Coulomb coefficient",
     [](Pair& p, double value) { p.mu = value; }},
}};

std::optional<KeyGap> LinearSpring::find_gap(const Pair& material) {
  if (material.kn > 0.0) return std::nullopt;
  return KeyGap{"without normal_stiffness",
                "add normal_stiffness to the material, or move its constants to a [[pair]]"};
}

std::optional<Pair> LinearSpring::mix(const Pair& a, const Pair& b) {
  const auto cn = dashpots_in_series(a.cn, b.cn);
  const auto ct = dashpots_in_series(a.ct, b.ct);
  const bool of_two_kinds = (a.restitution && !is_zero(b.cn)) || (b.restitution && !is_zero(a.cn));
  if (!cn || !ct || of_two_kinds) return std::nullopt;
  Pair mixed;
  mixed.kn = in_series(a.kn, b.kn);
  mixed.kt = in_series(a.kt, b.kt);
  mixed.cn = *cn;
  mixed.ct = *ct;
  mixed.mu = std::min(a.mu, b.mu);
  if (a.restitution && b.restitution)
    mixed.restitution = std::sqrt(*a.restitution) * std::sqrt(*b.restitution);
  mixed.is_mixed = true;
  return mixed;
}

void LinearSpring::solve(Pair& p, const ContactRules& rules) {
  if (!p.restitution) return;
  p.cn.critical = 2.0 * damping_ratio_for(*p.restitution, rules.no_tension) * std::sqrt(p.kn);
}

std::array<std::string, 5> LinearSpring::texts(const Pair& p) {
  return {fmt::format("{:.4g}", p.kn), fmt::format("{:.4g}", p.kt), text_of(p.cn), text_of(p.ct),
          fmt::format("{:.4g}", p.mu)};
}

double LinearSpring::restitution(const Pair& p, double reduced_mass, const ContactRules& rules) {
  if (p.restitution) return *p.restitution;
  return restitution_at(0.5 * coefficient(p.cn, reduced_mass) / std::sqrt(p.kn * reduced_mass),
                        rules.no_tension);
}

std::string LinearSpring::stiffer(double stiffness, double /*factor*/) {
  return fmt::format("normal_stiffness = {:.2g}", stiffness);
}

double LinearSpring::pressed_overlap(const Pair& p, double /*radius*/, double force) {
  return force / p.kn;
}

double LinearSpring::struck_overlap(const Pair& p, const Impact& impact) {
  return impact.speed * std::sqrt(impact.mass / p.kn);
}

double LinearSpring::duration(const Pair& p, const Impact& impact) {
  return std::numbers::pi * std::sqrt(impact.mass / p.kn);
}

double LinearSpring::coefficient(const Dashpot& dashpot, double reduced_mass) {
  return dashpot.constant + dashpot.rate * reduced_mass +
         dashpot.critical * std::sqrt(reduced_mass);
}

double LinearSpring::dashpot(const Pair& p, const Impact& impact) {
  return coefficient(p.cn, impact.mass);
}

double LinearSpring::largest_force(const Pair& p, double share, double overlap,
                                   const Impact& impact) {
  return (1.0 + p.mu) * std::max(share * p.kn * overlap, dashpot(p, impact) * impact.speed);
}

// A null row keeps no spring: with mu = 0 every contact slides, and 0·inverse_kt = 0 clears it.
void LinearSpring::write(const Pair& p, const ContactRules& rules, double* row) {
  row[Kn] = p.kn;
  row[Kt] = p.kt;
  row[InverseKt] = p.kt > 0.0 ? 1.0 / p.kt : 0.0;
  row[Mu] = p.mu;
  row[Cap] = rules.no_tension ? 0.0 : std::numeric_limits<double>::infinity();
  row[Cn] = p.cn.constant;
  row[Ct] = p.ct.constant;
  row[CnRate] = p.cn.rate;
  row[CtRate] = p.ct.rate;
  row[CnCritical] = p.cn.critical;
  row[CtCritical] = p.ct.critical;
}

LinearSpring::Level LinearSpring::level(const Pair& p) {
  if (p.cn.critical > 0.0 || p.ct.critical > 0.0) return Critical;
  return p.cn.rate > 0.0 || p.ct.rate > 0.0 ? Rate : Constant;
}

}  // namespace barchan
