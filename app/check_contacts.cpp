#include <barchan/app/check_contacts.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <barchan/app/readable.hpp>
#include <barchan/core/model/contact_range.hpp>
#include <barchan/core/model/mass.hpp>

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

template <class Law>
Restitution restitution_of(const ContactConstants& pair, const ContactRules& rules,
                           const InverseMasses& a, const InverseMasses& b) {
  const double heavy = std::min(a.low + b.of_heaviest, a.of_heaviest + b.low);
  const double one = Law::restitution(pair, 1.0 / heavy, rules),
               other = Law::restitution(pair, 1.0 / (a.high + b.high), rules);
  return {std::min(one, other), std::max(one, other)};
}

std::string restitution_text(const ContactConstants& pair, const Restitution& e) {
  const std::string number = e.high - e.low < 5e-4 ? fmt::format("{:.4g}", e.high)
                                                   : fmt::format("{:.3g} … {:.3g}", e.low, e.high);
  if (pair.is_mixed) return number + ", mixed";
  return pair.restitution ? number : number + ", of the dashpot";
}

/// A row for every pair of materials that has constants.
/// @param lossless  the names of those that lose no energy head on
template <class Law>
std::vector<std::vector<std::string>> rows_of(const LoadedDeck& loaded, std::string& lossless) {
  const Model& model = loaded.deck.model;
  const auto masses = inverse_masses(loaded);
  std::vector<std::vector<std::string>> rows{{"pair"}};
  rows[0].insert(rows[0].end(), std::begin(Law::kColumns), std::end(Law::kColumns));
  rows[0].emplace_back("restitution");
  const int n = static_cast<int>(model.materials.size());
  for (int a = 0; a < n; ++a) {
    for (int b = a; b < n; ++b) {
      const ContactConstants& pair = model.contacts.at(a, b);
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      if (!Law::acts(pair)) continue;  // a pair that cannot meet
      const std::string name = model.materials[i].name + "–" + model.materials[j].name;
      const bool can_meet =
          std::max(masses[i].low, masses[j].low) < kUnused && masses[i].high + masses[j].high > 0.0;
      const auto e = can_meet
                         ? restitution_of<Law>(pair, model.contacts.rules(), masses[i], masses[j])
                         : Restitution{};
      if (e.high == 1.0) lossless += (lossless.empty() ? "" : ", ") + name;
      rows.push_back({name});
      for (std::string& text : Law::texts(pair)) rows.back().push_back(std::move(text));
      rows.back().push_back(can_meet ? restitution_text(pair, e) : "–");
    }
  }
  return rows;
}

std::string describe(const ContactTable& contacts) {
  return with_law(contacts.law, [&]<class Law>(Law /*law*/) {
    std::string text = Law::kIsByRadius ? "linear springs of 2·E·R and dashpots, friction"
                                        : "linear springs and dashpots, friction";
    if (Law::kStiffens)
      text =
          fmt::format("{}, {}, friction", std::is_base_of_v<Jkr, Law> ? "JKR" : "Hertz",
                      contacts.tangential == Tangential::Mindlin ? "Mindlin by increments of force"
                                                                 : "Mindlin by displacement");
    constexpr const char* kAdhesion[] = {"", ", DMT adhesion", ", SJKR cohesion",
                                         ", SJKR2 cohesion", ", bridges of liquid"};
    text += kAdhesion[static_cast<int>(contacts.adhesion)];
    if (Law::kRolls) text += ", rolling springs";
    return contacts.twisting ? text + ", twisting" : text;
  });
}

}  // namespace

void print_contacts(const LoadedDeck& loaded) {
  const ContactTable& contacts = loaded.deck.model.contacts;
  std::string lossless;
  const auto rows = with_law(
      contacts.law, [&]<class Law>(Law /*law*/) { return rows_of<Law>(loaded, lossless); });
  std::printf("Contacts: %s%s\n%s", describe(contacts).c_str(),
              contacts.no_tension ? "" : "; normal forces may pull", table(rows).c_str());
  double largest = 0.0;
  for (const ParticleData& p : loaded.particles.particles) largest = std::max(largest, p.radius);
  if (const double range = contact_range(contacts, largest); range > 0.0)
    std::printf("  What touches holds up to %.3g m beyond touch, %.2g of the largest radius.\n",
                range, range / largest);
  if (!lossless.empty())
    std::printf("  Warning: restitution 1, head-on collisions lose no energy: %s\n",
                lossless.c_str());
}

}  // namespace barchan::app
