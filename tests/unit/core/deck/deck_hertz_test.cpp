// Hertz contacts in a deck: what follows from what, and every combination that has no meaning.
#include <barchan/core/deck/deck.hpp>

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <unit/core/deck_text.hpp>

namespace barchan {
namespace {

using deck_test::Edit;
using deck_test::edited;

/// Glass, sand and a wall of steel, which is rigid.
std::string hertz_deck() {
  return R"(dimension = 3
[domain]
lo = [0.0, 0.0, 0.0]
hi = [1.0, 1.0, 1.0]
[time]
step = 1e-5
steps = 10
[contact]
model = "hertz"
[[material]]
name = "glass"
density = 2500.0
young_modulus = 1e7
poisson_ratio = 0.25
restitution = 0.9
friction = 0.4
[[material]]
name = "sand"
density = 2600.0
young_modulus = 2e7
poisson_ratio = 0.2
restitution = 0.4
friction = 0.6
tangential_damping_ratio = 0.25
[[material]]
name = "steel"
density = 7800.0
rigid = true
restitution = 0.5
friction = 0.2
[[wall]]
name = "floor"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
material = "steel"
[[particles]]
kind = "list"
material = "glass"
particle = [{ position = [0.2, 0.5, 0.5], radius = 0.1 }]
[[particles]]
kind = "list"
material = "sand"
particle = [{ position = [0.8, 0.5, 0.5], radius = 0.1 }]
)";
}

Deck parse(std::initializer_list<Edit> edits) {
  return parse_deck(edited(hertz_deck(), edits), "test.toml");
}

TEST(HertzDeck, MakesPairsOfMaterials) {
  const ContactTable contacts = parse({}).model.contacts;

  const ContactConstants& p = contacts.at(0, 1);
  EXPECT_NEAR(p.young_star, 1.0 / (0.9375 / 1e7 + 0.96 / 2e7), 1e-3);
  EXPECT_NEAR(p.shear_star, 1.0 / (1.75 * 2.5 / 1e7 + 1.8 * 2.4 / 2e7), 1e-3);
  EXPECT_NEAR(p.restitution.value(), 0.6, 1e-15);
  EXPECT_EQ(p.mu, 0.4);
  EXPECT_EQ(p.tangential_ratio, 0.5);
  EXPECT_TRUE(p.is_mixed);
  EXPECT_EQ(contacts.at(1, 0).alpha, p.alpha);
  EXPECT_NEAR(contacts.at(0, 0).young_star, 1e7 / (2.0 * 0.9375), 1e-3);
  EXPECT_FALSE(contacts.at(0, 0).is_mixed);
  EXPECT_NEAR(contacts.at(0, 2).young_star, 1e7 / 0.9375, 1e-3);
  EXPECT_EQ(contacts.at(2, 2).young_star, 0.0);
  EXPECT_FALSE(contacts.reference_speed.has_value());
}

TEST(HertzDeck, ChangesOfAPairWhatItsTableSays) {
  const ContactTable contacts = parse({{"[[wall]]",
                                        "[[pair]]\nmaterials = [\"sand\", \"glass\"]\n"
                                        "restitution = 0.7\n[[wall]]"}})
                                    .model.contacts;

  const ContactConstants& p = contacts.at(0, 1);
  EXPECT_EQ(p.restitution, 0.7);
  EXPECT_FALSE(p.is_mixed);
  EXPECT_EQ(p.mu, 0.4);
  EXPECT_NEAR(p.young_star, 1.0 / (0.9375 / 1e7 + 0.96 / 2e7), 1e-3);
}

TEST(HertzDeck, ReadsTheRulesOfContacts) {
  const ContactTable contacts =
      parse({{"model = \"hertz\"",
              "model = \"hertz\"\ntangential = \"mindlin-displacement\"\nreference_speed = 3.0"}})
          .model.contacts;

  EXPECT_EQ(contacts.tangential, Tangential::MindlinDisplacement);
  EXPECT_EQ(contacts.reference_speed, 3.0);
}

TEST(HertzDeck, MixesAdhesion) {
  const ContactTable contacts =
      parse({{"model = \"hertz\"", "model = \"hertz\"\nadhesion = \"dmt\"\nrolling = \"spring\""},
             {"friction = 0.4", "friction = 0.4\nsurface_energy = 0.09\nrolling_friction = 0.1"},
             {"friction = 0.6", "friction = 0.6\nsurface_energy = 0.04\nrolling_friction = 0.1"}})
          .model.contacts;

  EXPECT_EQ(contacts.adhesion, Adhesion::Dmt);
  EXPECT_NEAR(contacts.at(0, 1).surface_energy, 0.06, 1e-15);
  EXPECT_EQ(contacts.at(0, 0).surface_energy, 0.09);
  EXPECT_EQ(contacts.at(0, 2).surface_energy, 0.0);
  EXPECT_EQ(contacts.at(0, 1).mu_rolling, 0.1);
}

TEST(HertzDeck, ReadsRollingAndTwisting) {
  const ContactTable contacts =
      parse({{"model = \"hertz\"",
              "model = \"hertz\"\nrolling = \"spring\"\ntwisting = \"marshall\""},
             {"friction = 0.4", "friction = 0.4\nrolling_friction = 0.2"},
             {"friction = 0.6",
              "friction = 0.6\nrolling_friction = 0.1\n"
              "rolling_stiffness_ratio = 4.0\nrolling_damping = 0.3"}})
          .model.contacts;

  EXPECT_TRUE(contacts.twisting);
  EXPECT_EQ(contacts.at(0, 1).mu_rolling, 0.1);
  EXPECT_EQ(contacts.at(0, 1).kr_ratio, 2.0);
  EXPECT_EQ(contacts.at(0, 1).cr, 0.0) << "in series with none";
  EXPECT_EQ(contacts.at(1, 1).cr, 0.3);
  EXPECT_EQ(contacts.at(0, 2).mu_rolling, 0.0);
}

TEST(Deck, RefusesTwistingDisksAndMixedRollingStiffness) {
  const auto expect = [](std::initializer_list<Edit> edits, const char* part) {
    const std::string message = deck_test::error_of(edits);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect({{"[[bond]]", "[contact]\ntwisting = \"marshall\"\n[[bond]]"}},
         "test.toml:20:12: twisting in 2D: disks turn about the third axis alone");
  expect({{"[[bond]]", "[contact]\nrolling = \"spring\"\n[[bond]]"},
          {"friction = 0.5", "rolling_friction = 0.5\nrolling_stiffness = 1e3"},
          {"friction = 0.6", "rolling_friction = 0.6"}},
         "different ways, which do not mix");
}

TEST(HertzDeck, AsksForARestitutionOfPairsThatMeetAlone) {
  EXPECT_NO_THROW((void)parse({{"rigid = true\nrestitution = 0.5", "rigid = true"},
                               {"[[wall]]",
                                "[[pair]]\nmaterials = [\"steel\", \"glass\"]\nrestitution = 0.7\n"
                                "[[pair]]\nmaterials = [\"steel\", \"sand\"]\nrestitution = 0.7\n"
                                "[[wall]]"}}));
}

struct Wrong {
  const char* name;
  std::string from, to;
  std::vector<std::string> parts;
};

std::ostream& operator<<(std::ostream& stream, const Wrong& wrong) {
  return stream << wrong.name;
}

class WrongHertzDeck : public testing::TestWithParam<Wrong> {};

TEST_P(WrongHertzDeck, IsRefusedWithPlaceAndRemedy) {
  const std::string message =
      deck_test::error_of(edited(hertz_deck(), {{GetParam().from, GetParam().to}}));

  for (const std::string& part : GetParam().parts)
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' in '" << message << "'";
}

INSTANTIATE_TEST_SUITE_P(
    Deck, WrongHertzDeck,
    testing::Values(
        Wrong{
            "UnknownModel", "\"hertz\"", "\"hertzian\"", {":9:9:", "is not one of linear, hertz"}},
        Wrong{"StiffnessOfALinearContact",
              "young_modulus = 1e7\npoisson_ratio = 0.25",
              "normal_stiffness = 1e5",
              {":13:20:", "'normal_stiffness' has no place where contact.model = \"hertz\"",
               "young_modulus, poisson_ratio", "model = \"linear\""}},
        Wrong{"ModuliOfALinearContact",
              "model = \"hertz\"",
              "model = \"linear\"",
              {":13:17:", "'young_modulus' has no place where contact.model = \"linear\"",
               "model = \"hertz\""}},
        Wrong{"TangentialOfALinearContact",
              "model = \"hertz\"",
              "model = \"linear\"\ntangential = \"mindlin\"",
              {":10:14:", "'tangential' has no place", "tangential_stiffness in N/m"}},
        Wrong{"ReferenceSpeedOfALinearContact",
              "model = \"hertz\"",
              "reference_speed = 1.0",
              {":9:19:", "'reference_speed' has no place", "as stiff at any speed"}},
        Wrong{"NoReferenceSpeed",
              "model = \"hertz\"",
              "model = \"hertz\"\nreference_speed = 0.0",
              {":10:19:", "out of range"}},
        Wrong{"DashpotOfALinearContact",
              "restitution = 0.9",
              "normal_damping = 0.9",
              {":15:18:", "'normal_damping' has no place"}},
        Wrong{"NoModulus",
              "young_modulus = 1e7\n",
              "",
              {":13:17:", "poisson_ratio without young_modulus", "rigid = true"}},
        Wrong{"NoPoissonRatio",
              "poisson_ratio = 0.25\n",
              "",
              {":13:17:", "young_modulus without poisson_ratio", "(-1, 0.5]"}},
        Wrong{"PoissonRatioTooLarge",
              "poisson_ratio = 0.25",
              "poisson_ratio = 0.6",
              {":14:17:", "out of range", "number in (-1, 0.5]"}},
        Wrong{"RigidWithAModulus",
              "rigid = true",
              "rigid = true\nyoung_modulus = 1e11",
              {":29:17:", "beside rigid = true"}},
        Wrong{"RigidParticles",
              "material = \"sand\"",
              "material = \"steel\"",
              {"'steel' is rigid, and particles are made of it", "rigid is for walls"}},
        Wrong{"ModulusOfAPair",
              "[[wall]]",
              "[[pair]]\nmaterials = [\"glass\", \"sand\"]\nyoung_modulus = 1e7\n[[wall]]",
              {":33:1:", "young_modulus", "[[material]]"}},
        Wrong{"PairOfAMaterialWithoutModuli",
              "rigid = true\nrestitution = 0.5\nfriction = 0.2\n",
              "[[pair]]\nmaterials = [\"glass\", \"steel\"]\nrestitution = 0.7\n",
              {"'steel' has no constants of its own", "young_modulus in Pa and poisson_ratio"}},
        Wrong{"WallWithoutModuli",
              "rigid = true\nrestitution = 0.5\nfriction = 0.2\n",
              "",
              {"missing material pair", "'glass' and 'steel'"}},
        Wrong{"NoRestitution",
              "restitution = 0.9\n",
              "",
              {"contacts of 'glass' and 'glass' have no restitution", "add restitution"}},
        Wrong{"RollingWithoutASpring",
              "friction = 0.4",
              "friction = 0.4\nrolling_friction = 0.1",
              {":17:20:", "'rolling_friction' has no place without contact.rolling = \"spring\"",
               "write rolling = \"spring\""}},
        Wrong{"RollingOfTwistingAlone",
              "model = \"hertz\"",
              "model = \"hertz\"\ntwisting = \"marshall\"\n[[pair]]\n"
              "materials = [\"glass\", \"sand\"]\nrolling_damping = 0.1",
              {":13:19:", "'rolling_damping' has no place without contact.rolling = \"spring\""}},
        Wrong{"RollingOfNobody",
              "model = \"hertz\"",
              "model = \"hertz\"\nrolling = \"spring\"",
              {":10:11:", "no pair of materials has rolling_friction"}},
        Wrong{"TwoRollingStiffnesses",
              "model = \"hertz\"",
              "model = \"hertz\"\nrolling = \"spring\"\n[[pair]]\n"
              "materials = [\"glass\", \"sand\"]\nrolling_stiffness = 1e3\n"
              "rolling_stiffness_ratio = 1.0",
              {"both rolling_stiffness_ratio and rolling_stiffness"}},
        Wrong{"SurfaceEnergyWithoutAdhesion",
              "friction = 0.4",
              "friction = 0.4\nsurface_energy = 0.05",
              {":17:18:", "'surface_energy' has no place without contact.adhesion = \"dmt\"",
               "write adhesion = \"dmt\" or model = \"jkr\" in [contact]"}},
        Wrong{
            "CohesionUnderDmt",
            "model = \"hertz\"",
            "model = \"hertz\"\nadhesion = \"dmt\"\n[[pair]]\n"
            "materials = [\"glass\", \"sand\"]\ncohesion_density = 1e4",
            {":13:20:", "'cohesion_density' has no place without contact.adhesion = \"sjkr\" or"}},
        Wrong{"DmtOfNobody",
              "model = \"hertz\"",
              "model = \"hertz\"\nadhesion = \"dmt\"",
              {":10:12:", "no pair of materials has surface_energy"}},
        Wrong{"SjkrOfNobody",
              "model = \"hertz\"",
              "model = \"hertz\"\nadhesion = \"sjkr2\"",
              {":10:12:", "no pair of materials has cohesion_density"}},
        Wrong{"BridgeOfNobody",
              "model = \"hertz\"",
              "model = \"hertz\"\nadhesion = \"bridge\"",
              {":10:12:", "there is no [[bridge]]", "surface_tension and volume"}},
        Wrong{"BridgeWithoutAdhesion",
              "model = \"hertz\"",
              "model = \"hertz\"\n[[bridge]]\nmaterials = [\"glass\", \"sand\"]\n"
              "surface_tension = 0.07\nvolume = 1e-12",
              {"no place without contact.adhesion = \"bridge\""}},
        Wrong{"BridgeTwice",
              "model = \"hertz\"",
              "model = \"hertz\"\nadhesion = \"bridge\"\n"
              "[[bridge]]\nmaterials = [\"glass\", \"sand\"]\nsurface_tension = 0.07\n"
              "volume = 1e-12\n"
              "[[bridge]]\nmaterials = [\"sand\", \"glass\"]\nsurface_tension = 0.07\n"
              "volume = 1e-12",
              {"a second [[bridge]] of 'sand' and 'glass'"}},
        Wrong{"BridgeThatDoesNotWet",
              "model = \"hertz\"",
              "model = \"hertz\"\nadhesion = \"bridge\"\n[[bridge]]\n"
              "materials = [\"glass\", \"sand\"]\nsurface_tension = 0.07\n"
              "contact_angle = 90.0\nvolume = 1e-12",
              {"contact_angle = 90", "below 90"}},
        Wrong{"JkrOfNobody",
              "model = \"hertz\"",
              "model = \"jkr\"",
              {"no pair of materials has surface_energy", "model = \"hertz\""}},
        Wrong{"AdhesionOfJkrContacts",
              "model = \"hertz\"",
              "model = \"jkr\"\nadhesion = \"dmt\"",
              {":10:12:", "an attraction of their own"}},
        Wrong{"PullOffOfHertzContacts",
              "model = \"hertz\"",
              "model = \"hertz\"\npull_off = \"peak\"",
              {":10:12:", "'pull_off' has no place where contact.model = \"hertz\""}},
        Wrong{"AdhesionOfLinearContacts",
              "model = \"hertz\"",
              "model = \"linear\"\nadhesion = \"sjkr\"",
              {":10:12:", "linear contacts do not stick", "model = \"hertz\""}},
        Wrong{"RollingByNoStiffness",
              "model = \"hertz\"\n[[material]]\nname = \"glass\"\ndensity = 2500.0\n"
              "young_modulus = 1e7\npoisson_ratio = 0.25\nrestitution = 0.9\nfriction = 0.4",
              "model = \"hertz\"\nrolling = \"spring\"\n[[material]]\nname = \"glass\"\n"
              "density = 2500.0\nyoung_modulus = 1e7\npoisson_ratio = 0.25\nrestitution = 0.9\n"
              "rolling_friction = 0.1",
              {"contacts of 'glass' and 'glass' have rolling_friction", "friction is zero",
               "or rolling_stiffness"}},
        Wrong{"UnmixedPair",
              "model = \"hertz\"",
              "model = \"hertz\"\nmixing = \"none\"",
              {"missing material pair", "add a [[pair]]"}}),
    [](const auto& given) { return std::string(given.param.name); });

TEST(HertzDeck, HasNoDisks) {
  const std::string message =
      deck_test::error_of({{"[[bond]]", "[contact]\nmodel = \"hertz\"\n[[bond]]"}});

  for (const char* part : {"test.toml:20:9:", "no Hertz law", "dimension = 3 for spheres"})
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' in '" << message << "'";
}

TEST(HertzDeck, IsMissedByADeckOfDisksWithModuli) {
  const std::string message =
      deck_test::error_of({{"normal_stiffness = 55000.0", "young_modulus = 1e7"}});

  EXPECT_NE(message.find("test.toml:12:17: 'young_modulus' has no place where contact.model = "
                         "\"linear\""),
            std::string::npos)
      << message;
}

}  // namespace
}  // namespace barchan
