#include <barchan/app/check_contacts.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <barchan/app/readable.hpp>
#include <barchan/core/mass.hpp>
#include <barchan/core/restitution.hpp>

namespace barchan::app {
namespace {

constexpr double kUnused = std::numeric_limits<double>::infinity();

/// Smallest and largest 1/m of what is made of a material. Walls and fixed particles have 0.
struct InverseMasses {
  double low = kUnused, high = 0.0;
  double of_heaviest = low;  ///< of what moves

  void take(double inverse) {
    low = std::min(low, inverse);
    high = std::max(high, inverse);
    if (inverse > 0.0) of_heaviest = std::min(of_heaviest, inverse);
  }
};

std::vector<InverseMasses> inverse_masses(const LoadedDeck& loaded) {
  const Model& model = loaded.deck.model;
  std::vector<InverseMasses> masses(model.materials.size());
  for (const WallSpec& wall : model.walls) masses[static_cast<std::size_t>(wall.material)].take(0);
  for (const ParticleData& p : loaded.particles.particles) {
    masses[static_cast<std::size_t>(p.type)].take(p.fixed ? 0.0
                                                          : 1.0 / mass_of(p, model.dimension));
  }
  return masses;
}

struct Restitution {
  double low = 0.0, high = 0.0;
};

Restitution restitution_of(const ContactConstants& law, bool no_tension, const InverseMasses& a,
                           const InverseMasses& b) {
  if (law.restitution) return {*law.restitution, *law.restitution};
  const auto at = [&](double inverse_mass) {
    const double m = 1.0 / inverse_mass;
    const double cn = law.cn.constant + law.cn.rate * m + law.cn.critical * std::sqrt(m);
    return restitution_at(0.5 * cn / std::sqrt(law.kn * m), no_tension);
  };
  const double heavy = std::min(a.low + b.of_heaviest, a.of_heaviest + b.low);
  const double one = at(heavy), other = at(a.high + b.high);
  return {std::min(one, other), std::max(one, other)};
}

std::string dashpot_text(const Dashpot& d) {
  if (d.rate > 0.0) return fmt::format("{:.4g} · m/s", d.rate);
  if (d.critical > 0.0) return fmt::format("{:.4g} · √m", d.critical);
  return fmt::format("{:.4g}", d.constant);
}

std::string restitution_text(const ContactConstants& law, const Restitution& e) {
  const std::string number = e.high - e.low < 5e-4 ? fmt::format("{:.4g}", e.high)
                                                   : fmt::format("{:.3g} … {:.3g}", e.low, e.high);
  if (law.is_mixed) return number + ", mixed";
  return law.restitution ? number : number + ", of the dashpot";
}

}  // namespace

void print_contacts(const LoadedDeck& loaded) {
  const Model& model = loaded.deck.model;
  const auto masses = inverse_masses(loaded);
  std::vector<std::vector<std::string>> rows{
      {"pair", "kn [N/m]", "kt [N/m]", "cn [N·s/m]", "ct [N·s/m]", "friction", "restitution"}};
  std::string lossless;
  const int n = static_cast<int>(model.materials.size());
  for (int a = 0; a < n; ++a) {
    for (int b = a; b < n; ++b) {
      const ContactConstants& law = model.contacts.at(a, b);
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      if (law.kn == 0.0) continue;  // a pair that cannot meet
      const std::string name = model.materials[i].name + "–" + model.materials[j].name;
      const bool can_meet =
          std::max(masses[i].low, masses[j].low) < kUnused && masses[i].high + masses[j].high > 0.0;
      const auto e = can_meet ? restitution_of(law, model.contacts.no_tension, masses[i], masses[j])
                              : Restitution{};
      if (e.high == 1.0) lossless += (lossless.empty() ? "" : ", ") + name;
      rows.push_back({name, fmt::format("{:.4g}", law.kn), fmt::format("{:.4g}", law.kt),
                      dashpot_text(law.cn), dashpot_text(law.ct), fmt::format("{:.4g}", law.mu),
                      can_meet ? restitution_text(law, e) : "–"});
    }
  }
  std::printf("Contacts:%s\n%s", model.contacts.no_tension ? "" : " (normal forces may pull)",
              table(rows).c_str());
  if (!lossless.empty())
    std::printf("  Warning: restitution 1, head-on collisions lose no energy: %s\n",
                lossless.c_str());
}

}  // namespace barchan::app
