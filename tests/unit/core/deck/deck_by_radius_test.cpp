// Linear contacts by moduli and radii in a deck: what follows, and what has no place.
#include <barchan/core/deck/deck.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <unit/core/deck_text.hpp>

namespace barchan {
namespace {

using deck_test::edited;

/// Lines count from 1: [contact] is in line 8.
std::string by_radius() {
  return R"(dimension = 2
[domain]
lo = [0.0, 0.0]
hi = [1.0, 1.0]
[time]
step = 1e-5
steps = 10
[contact]
stiffness = "radius"
[[material]]
name = "soft"
density = 1000.0
young_modulus = 1e6
restitution = 0.9
friction = 0.4
[[material]]
name = "hard"
density = 1000.0
young_modulus = 3e6
restitution = 0.4
friction = 0.6
tangential_stiffness_ratio = 0.5
[[wall]]
name = "floor"
point = [0.0, 0.0]
normal = [0.0, 1.0]
material = "hard"
[[particles]]
kind = "list"
material = "soft"
particle = [{ position = [0.2, 0.5], radius = 0.1 }]
)";
}

TEST(DeckByRadius, HasTheHarmonicMeanOfModuliAndTheGeometricOfRatios) {
  const Deck deck = parse_deck(by_radius(), "test.toml");

  const ContactConstants& p = deck.model.contacts.at(0, 1);
  EXPECT_DOUBLE_EQ(p.young_star, 1.5e6);
  EXPECT_DOUBLE_EQ(p.mu, 0.4);
  EXPECT_DOUBLE_EQ(p.restitution.value(), 0.6);
  EXPECT_DOUBLE_EQ(p.kt_ratio, std::sqrt(2.0 / 7.0 * 0.5));
  EXPECT_DOUBLE_EQ(LinearByRadius::at(p, 0.1).kn, 3e5);
  EXPECT_DOUBLE_EQ(LinearByRadius::at(p, 0.1).kt, p.kt_ratio * 3e5);
}

TEST(DeckByRadius, TakesARestitutionOfAPair) {
  const std::string pair =
      "[[pair]]\nmaterials = [\"soft\", \"hard\"]\nrestitution = 0.5\n[[wall]]";

  const Deck deck = parse_deck(edited(by_radius(), {{"[[wall]]", pair}}), "test.toml");

  const ContactConstants& p = deck.model.contacts.at(1, 0);
  EXPECT_DOUBLE_EQ(p.restitution.value(), 0.5);
  EXPECT_DOUBLE_EQ(p.young_star, 1.5e6);
}

struct Wrong {
  const char *name, *from, *to;
  std::vector<std::string> parts;
};

class WrongDeckByRadius : public testing::TestWithParam<Wrong> {};

TEST_P(WrongDeckByRadius, IsRefusedWithPlaceAndRemedy) {
  const std::string message =
      deck_test::error_of(edited(by_radius(), {{GetParam().from, GetParam().to}}));

  for (const std::string& part : GetParam().parts)
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' in '" << message << "'";
}

INSTANTIATE_TEST_SUITE_P(
    Deck, WrongDeckByRadius,
    testing::Values(
        Wrong{"AGivenStiffness",
              "young_modulus = 1e6",
              "normal_stiffness = 1e5",
              {":13:20:", "'normal_stiffness' has no place where contact.stiffness = \"radius\"",
               "young_modulus, tangential_stiffness_ratio", "leave stiffness out"}},
        Wrong{"PoissonRatio",
              "young_modulus = 1e6",
              "young_modulus = 1e6\npoisson_ratio = 0.3",
              {":14:17:", "'poisson_ratio' has no place where contact.stiffness = \"radius\""}},
        Wrong{"ARatioOfGivenStiffness",
              "stiffness = \"radius\"\n[[material]]\nname = \"soft\"\ndensity = "
              "1000.0\nyoung_modulus = 1e6",
              "no_tension = true\n[[material]]\nname = \"soft\"\ndensity = 1000.0\n"
              "normal_stiffness = 1e5\ntangential_stiffness_ratio = 0.5",
              {":14:30:",
               "'tangential_stiffness_ratio' has no place where contact.model = \"linear\"",
               "stiffness = \"radius\""}},
        Wrong{
            "OfHertzContacts",
            "stiffness = \"radius\"",
            "stiffness = \"radius\"\nmodel = \"hertz\"",
            {":9:13:", "'stiffness' has no place where contact.model = \"hertz\"", "leave it out"}},
        Wrong{"UnknownChoice",
              "\"radius\"",
              "\"diameter\"",
              {":9:13:", "is not one of given, radius"}},
        Wrong{"NoModulus",
              "young_modulus = 1e6\n",
              "",
              {":13:15:", "restitution without young_modulus", "add young_modulus"}},
        Wrong{"NoRestitution",
              "restitution = 0.9\n",
              "",
              {"contacts of 'soft' and 'soft' have no restitution", "add restitution"}},
        Wrong{"AModulusOfAPair",
              "[[wall]]",
              "[[pair]]\nmaterials = [\"soft\", \"hard\"]\nyoung_modulus = 1e6\n[[wall]]",
              {":25:1:", "young_modulus is a key of"}},
        Wrong{"Adhesion",
              "stiffness = \"radius\"",
              "stiffness = \"radius\"\nadhesion = \"dmt\"",
              {":10:12:", "linear contacts do not stick"}},
        Wrong{"Rolling",
              "friction = 0.4",
              "friction = 0.4\nrolling_friction = 0.1",
              {"'rolling_friction' has no place without contact.rolling = \"spring\""}}),
    [](const auto& given) { return std::string(given.param.name); });

}  // namespace
}  // namespace barchan
