// Heat in a deck: where temperatures come from, and every combination that has no meaning.
#include <barchan/core/deck/deck.hpp>

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <barchan/core/generators/make_particles.hpp>

#include <unit/core/deck_text.hpp>

namespace barchan {
namespace {

using deck_test::edited;
using deck_test::error_of;

std::string heat_deck() {
  return R"(dimension = 3
[domain]
lo = [0.0, 0.0, 0.0]
hi = [1.0, 1.0, 1.0]
[time]
step = 1e-5
steps = 10
[heat]
temperature = 310.0
[[material]]
name = "glass"
density = 2500.0
normal_stiffness = 1e4
conductivity = 0.8
heat_capacity = 840.0
[[material]]
name = "steel"
density = 7800.0
normal_stiffness = 1e4
conductivity = 50.0
[[wall]]
name = "plate"
material = "steel"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
temperature = 400.0
[[particles]]
kind = "list"
material = "glass"
temperature = 320.0
particle = [{ position = [0.2, 0.5, 0.5], radius = 0.1 },
            { position = [0.5, 0.5, 0.5], radius = 0.1, temperature = 330.0 }]
[[particles]]
kind = "lattice"
material = "glass"
region = { lo = [0.6, 0.0, 0.0], hi = [0.9, 0.3, 0.3] }
radius = 0.1
)";
}

TEST(HeatDeck, SaysHowWarmEachParticleIs) {
  const Deck deck = parse_deck(heat_deck(), "test.toml");
  const ParticleSet set = make_particles(deck.model, deck.sources);

  std::vector<double> temperatures;
  for (const ParticleData& p : set.particles) temperatures.push_back(p.temperature);
  EXPECT_EQ(temperatures, (std::vector<double>{320.0, 330.0, 310.0}));
  EXPECT_EQ(deck.model.walls[0].temperature, 400.0);
  EXPECT_EQ(deck.model.materials[1].conductivity, 50.0);
}

TEST(HeatDeck, RefusesWhatHasNoMeaning) {
  struct Case {
    deck_test::Edit edit;
    std::vector<std::string> parts;
  };
  const std::vector<Case> cases{
      {{"heat_capacity = 840.0", ""},
       {":11:8: 'glass' has no heat_capacity, and particles", "add heat_capacity in J/(kg·K)"}},
      {{"conductivity = 0.8", ""}, {":11:8: 'glass' has no conductivity, and particles"}},
      {{"conductivity = 50.0", ""},
       {":17:8: 'steel' has no conductivity, and wall 'plate' of it keeps a temperature"}},
      {{"heat_capacity = 840.0", "heat_capacity = 0.0"}, {":15:17: heat_capacity = 0"}},
      {{"temperature = 400.0", "temperature = -4.0"}, {":26:15: temperature = -4"}},
      {{"temperature = 400.0", "temperature = 400.0\nheat_flux = 1.0"},
       {"both temperature and heat_flux"}},
      {{"[heat]\ntemperature = 310.0\n", ""},
       {":12:16: conductivity is given, but the deck has no table [heat]", "add [heat]"}},
      {{"[heat]\n", "[heat]\nfriction = true\n"}, {"friction", "[heat]"}},
  };
  for (const Case& c : cases) {
    const std::string message = error_of(edited(heat_deck(), {c.edit}));
    for (const std::string& part : c.parts)
      EXPECT_NE(message.find(part), std::string::npos) << message << " lacks " << part;
  }
}

}  // namespace
}  // namespace barchan
