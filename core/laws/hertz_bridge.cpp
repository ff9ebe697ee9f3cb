#include <barchan/core/laws/hertz_bridge.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace barchan {
namespace {

constexpr double kPi = std::numbers::pi;

/// ∫ dx/(1 + 1.05·x + 2.5·x²) from 0 to x, but for a constant.
double integral_of_fit(double x) {
  const double q = std::sqrt(4.0 * 2.5 - 1.05 * 1.05);
  return 2.0 / q * std::atan((5.0 * x + 1.05) / q);
}

}  // namespace

double HertzBridge::rupture(const Pair& p) {
  return (1.0 + 0.5 * p.bridge.contact_angle) * std::cbrt(p.bridge.volume);
}

std::array<std::string, 6> HertzBridge::texts(const Pair& p) {
  const auto base = HertzMindlin::texts(p);
  const bool is_wet = p.bridge.volume > 0.0;
  return {base[0],
          base[1],
          base[2],
          base[3],
          is_wet ? fmt::format("{:.4g}", p.bridge.surface_tension) : "–",
          is_wet ? fmt::format("{:.4g}", rupture(p)) : "–"};
}

double HertzBridge::largest_force(const Pair& p, double share, double overlap,
                                  const Impact& impact) {
  return HertzMindlin::largest_force(p, share, overlap, impact) +
         2.0 * share * 4.0 * kPi * p.bridge.surface_tension * impact.radius;
}

void HertzBridge::write(const Pair& p, const ContactRules& rules, double* row) {
  HertzMindlin::write(p, rules, row);
  const bool is_wet = p.bridge.volume > 0.0;
  row[Pull] =
      is_wet ? 4.0 * kPi * p.bridge.surface_tension * std::cos(p.bridge.contact_angle) : 0.0;
  row[Scale] = is_wet ? 2.0 / p.bridge.volume : 0.0;
  row[Rupture] = rupture(p);
}

// Of the bridge, from its rupture; where one forms or ruptures, the difference is lost.
double HertzBridge::energy(const double* row, const History& history, const Overlap& overlap,
                           const double* numbers) {
  const double touching =
      overlap.depth > 0.0 ? HertzMindlin::energy(row, history, overlap, numbers) : 0.0;
  if (row[Rupture] == 0.0) return touching;
  const double scale = std::sqrt(row[Scale] / overlap.inverse_radius);  // of gaps [1/m]
  const double gap = std::max(0.0, -overlap.depth), depth = std::max(0.0, overlap.depth);
  const double path =
      (integral_of_fit(scale * row[Rupture]) - integral_of_fit(scale * gap)) / scale + depth;
  return touching - row[Pull] / overlap.inverse_radius * path;
}

}  // namespace barchan
