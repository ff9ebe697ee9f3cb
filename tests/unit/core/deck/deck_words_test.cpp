// What a deck says of physics that barchan leaves out, and whole numbers that are written with an
// exponent.
#include <barchan/core/deck/deck.hpp>

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <barchan/core/base/nearest.hpp>
#include <barchan/core/deck/not_modelled.hpp>
#include <barchan/core/deck/schema.hpp>

#include <unit/core/deck_text.hpp>

namespace barchan {
namespace {

using deck_test::Edit;
using deck_test::error_of;
using deck_test::parse_edited;

void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' in '" << message << "'";
}

TEST(Nearest, CountsASwapOfTwoLettersAsOneMistake) {
  EXPECT_EQ(deck::edit_distance("velocity", "velocity"), 0U);
  EXPECT_EQ(deck::edit_distance("vleocity", "velocity"), 1U);
  EXPECT_EQ(deck::edit_distance("velocit", "velocity"), 1U);
  EXPECT_EQ(deck::edit_distance("velozity", "velocity"), 1U);
  EXPECT_EQ(deck::edit_distance("vleoccity", "velocity"), 2U);
}

TEST(NotModelled, IsCalledThatInsteadOfAMisspeltKey) {
  struct Case {
    std::string key, physics;
  };
  const std::vector<Case> cases{
      {"twisting_friction", "twisting by constants of its own is"},
      {"torsion_stiffness", "twisting by constants of its own is"},
      {"suction", "adhesion by van der Waals forces at a distance, or by liquid that flows, is"},
      {"liquidVolume", "adhesion by van der Waals forces at a distance, or by liquid that"},
      {"shear_modulus", "elasticity by any moduli but"},
      {"contact_law", "any law of contact but"},
      {"emissivity", "heat other than conduction"},
      {"thermal_conductivity", "heat other than conduction"},
      {"viscosity", "viscosity is"},
      {"drag_coefficient", "a fluid is"},
      {"yield_stress", "plastic deformation, wear and breakage"},
      {"static_friction", "friction that depends on speed is"},
      {"charge", "electric and magnetic forces are"},
      {"shape", "any particle but disks and spheres is"}};
  for (const Case& c : cases) {
    const std::string message = error_of({{"friction = 0.5", c.key + " = 0.5"}});
    expect_parts(message, {"test.toml:13:1: " + c.key + " in [[material]]: " + c.physics,
                           " not modelled ("});
    EXPECT_EQ(message.find("did you mean"), std::string::npos) << message;
  }
}

TEST(NotModelled, IsCalledThatInEveryTable) {
  expect_parts(error_of({{"young_modulus = 1e6", "poisson_ratio = 0.3"}}),
               {":21:1: poisson_ratio in [[bond]]", "not modelled", "stiffness_ratio"});
  expect_parts(error_of({{"gravity = [0.0, -9.81]", "fluid = { density = 1000.0 }"}}),
               {":2:1: fluid at the top level: a fluid is not modelled"});
  expect_parts(error_of({{"max_time = 1.0", "strain_rate = 1.0"}}),
               {":29:1: strain_rate in [[stage]]", "a strain rate is not modelled"});
  expect_parts(error_of({{"hi = [10.0, 5.0]", "lees_edwards = 1.0"}}),
               {":5:1: lees_edwards in [domain]: sheared periodic borders are not modelled"});
  expect_parts(error_of({{"name = \"floor\"", "omega = 1.0"}}),
               {":23:1: omega in [[wall]]: a wall that turns is not modelled"});
  expect_parts(error_of({{"point = [0.0, 0.0]", "kind = \"cylinder\"\npoint = [0.0, 0.0]"}}),
               {":24:8: kind = \"cylinder\" is not one of", "not modelled"});
  expect_parts(error_of({{"kind = \"packing\"", "kind = \"clump\""}}),
               {":31:8:", "any particle but disks and spheres is not modelled"});
}

TEST(NotModelled, LeavesSlipsToTheNearestKey) {
  expect_parts(error_of({{"young_modulus", "young_modulos"}}),
               {":21:1: unknown key", "did you mean 'young_modulus'?"});
  expect_parts(error_of({{"friction = 0.5", "frictoin = 0.5"}}), {"did you mean 'friction'?"});
  expect_parts(error_of({{"friction = 0.5", "friction_angle = 30.0"}}), {"known: name, density"});
  expect_parts(error_of({{"max_time = 1.0", "omega = 1.0"}}), {"omega is a key of [[particles]]"});
  expect_parts(error_of({{"friction = 0.5", "surface_tension = 0.07"}}),
               {"is a key of [[bridge]]"});
}

TEST(NotModelled, IsNoKeyOrChoiceOfTheDeck) {
  for (const deck::KeySpec& spec : deck::key_specs()) {
    EXPECT_FALSE(deck::find_not_modelled(spec.table, spec.key).has_value())
        << spec.table << " " << spec.key;
    for (const std::string_view choice : deck::split_choices(spec.choices))
      EXPECT_FALSE(deck::find_not_modelled(spec.table, choice)) << spec.table << " " << choice;
  }
}

TEST(WholeNumbers, MayHaveAnExponent) {
  const Deck deck = parse_edited({{"end = 2.0", "steps = 2e4"}, {"count = 1000", "count = 1.0e3"}});

  EXPECT_EQ(deck.model.time.num_steps, 20000);
  EXPECT_EQ(std::get<PackingSource>(deck.sources[0].kind).count, 1000);
}

TEST(WholeNumbers, AreReadAsIdsToo) {
  const Deck deck =
      parse_edited({{"bond = \"pipe\"\n", "bond = \"pipe\"\nbond_pairs = [[1e0, 2.0]]\n"}});

  ASSERT_EQ(deck.sources[1].links.pairs.size(), 1u);
  EXPECT_EQ(deck.sources[1].links.pairs[0], (std::pair<std::int64_t, std::int64_t>{1, 2}));
  expect_parts(error_of({{"bond = \"pipe\"\n", "bond = \"pipe\"\nbond_pairs = [[1.5, 2]]\n"}}),
               {":44:16:", "1.5 is not a whole number"});
}

TEST(WholeNumbers, ThatAreNoneAreCalledThat) {
  const auto error = [](const char* steps) { return error_of({{"end = 2.0", steps}}); };

  expect_parts(error("steps = 1.5"),
               {":8:9: steps = 1.5 is not a whole number", "such as 1000 or 1e3"});
  expect_parts(error("steps = 1e17"), {":8:9: steps = 1e+17 is too large", "9007199254740992"});
  expect_parts(error("steps = -1e3"), {":8:9: steps = -1000 is out of range", "write an integer"});
  expect_parts(error("steps = [7]"),
               {":8:9: steps: expected an integer, found an array (write one"});
  expect_parts(error("steps = inf"), {":8:9: steps is not finite"});
  expect_parts(error("steps = \"1e3\""), {":8:9: steps: expected an integer, found a string"});
}

TEST(WholeNumbers, Beyond64BitsNameTheLimit) {
  expect_parts(error_of({{"count = 1000", "count = 99999999999999999999"}}),
               {":34:", "64 bits", "(whole numbers go up to 9223372036854775807)"});
}

TEST(Forms, OfARadiusAreNamed) {
  const auto error = [](const char* radius) { return error_of({{"[0.04, 0.06]", radius}}); };
  const char* const remedy = "(write one radius, [min, max], or [{ radius = ..., weight = ... }";

  expect_parts(error("{ min = 0.04, max = 0.06 }"),
               {":33:10: radius: expected a number or an array, found a table", remedy});
  expect_parts(error("\"0.04 m\""), {":33:10:", "found a string", remedy});
  expect_parts(error("[{ min = 0.04, max = 0.06 }]"),
               {":33:11: radius: a size class without a radius", remedy});
  expect_parts(error("[0.04, 0.05, 0.06]"), {":33:10: radius: an array of 3 numbers", remedy});
}

TEST(Forms, OfTablesAreNamed) {
  expect_parts(error_of({{"holes = [{ center = [5.0, 1.5], radius = 0.6 }]",
                          "holes = { center = [5.0, 1.5], radius = 0.6 }"}}),
               {":35:9: holes: expected an array of tables", "write holes = [{ ... }, ...]"});
  expect_parts(error_of({{"[[wall]]", "[wall]"}}),
               {":22:1: wall: expected an array of tables", "head each with [[wall]]"});
}

}  // namespace
}  // namespace barchan
