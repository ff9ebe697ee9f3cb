#include <barchan/core/deck/deck.hpp>

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <barchan/core/laws/restitution.hpp>

#include <unit/core/deck_text.hpp>

namespace barchan {
namespace {

using deck_test::good_deck;
using deck_test::parse_edited;

const ContactConstants& soil_duct(const Deck& deck) {
  return deck.model.contacts.at(0, 1);
}

TEST(Deck, ReadsEveryTableIntoTheModel) {
  const Deck deck = parse_deck(good_deck(), "folder/test.toml");

  EXPECT_EQ(deck.model.deck_file, "folder/test.toml");
  EXPECT_EQ(deck.model.dimension, 2);
  EXPECT_EQ(deck.model.gravity, Vec3(0.0, -9.81, 0.0));
  EXPECT_EQ(deck.model.domain.hi, Vec3(10.0, 5.0, 0.0));
  EXPECT_EQ(deck.model.time.num_steps, 20000);
  ASSERT_EQ(deck.model.materials.size(), 2u);
  EXPECT_EQ(deck.model.bond_laws.at(0).young_modulus, 1e6);
  EXPECT_EQ(deck.model.walls.at(0).normal, Vec3(0.0, 1.0, 0.0));
  EXPECT_EQ(deck.model.stages.at(0).max_time, 1.0);
  EXPECT_EQ(deck.sources.size(), 2u);
}

TEST(Deck, GivesDefaultsToWhatIsLeftOut) {
  const Deck deck = parse_deck(good_deck(), "test.toml");

  EXPECT_TRUE(deck.model.contacts.no_tension);
  EXPECT_EQ(deck.model.search.kind, ContactSearchKind::Cells);
  EXPECT_FALSE(deck.model.search.skin.has_value());
  EXPECT_EQ(deck.model.output.series_every, 0);
  EXPECT_TRUE(deck.model.output.picture);
  EXPECT_EQ(deck.model.checkpoint.keep, 2);
  EXPECT_EQ(deck.model.bond_laws.at(0).stiffness_ratio, 2.5);
  EXPECT_TRUE(std::isinf(deck.model.bond_laws.at(0).tensile_strength));
}

TEST(Deck, MakesOneStageWhereNoneIsGiven) {
  const Deck deck = parse_edited({{"[[stage]]\nname = \"settle\"\nmax_time = 1.0\n", ""}});

  ASSERT_EQ(deck.model.stages.size(), 1u);
  EXPECT_EQ(deck.model.stages[0].name, "run");
  EXPECT_TRUE(std::isinf(deck.model.stages[0].max_time));
}

TEST(Deck, CutsStripsAlongTheLongestAxisUnlessTold) {
  EXPECT_EQ(parse_edited({{"hi = [10.0, 5.0]", "hi = [10.0, 50.0]"}}).model.domain.strip_axis, 1);
  EXPECT_EQ(parse_edited({{"hi = [10.0, 5.0]", "hi = [10.0, 50.0]\nstrip_axis = \"x\""}})
                .model.domain.strip_axis,
            0);
}

TEST(Deck, TurnsNamesOfAxesIntoPeriodicity) {
  const Deck deck = parse_edited({{"hi = [10.0, 5.0]", "hi = [10.0, 5.0]\nperiodic = [\"x\"]"}});

  EXPECT_TRUE(deck.model.domain.periodic[0]);
  EXPECT_FALSE(deck.model.domain.periodic[1]);
}

TEST(Deck, MixesPairsInSeriesWithTheSmallerFriction) {
  const Deck deck = parse_deck(good_deck(), "test.toml");

  EXPECT_NEAR(soil_duct(deck).kn, 2.0 * 55000.0 * 65000.0 / 120000.0, 1e-9);
  EXPECT_EQ(soil_duct(deck).mu, 0.5);
  EXPECT_EQ(deck.model.contacts.at(1, 0).kn, soil_duct(deck).kn);
  EXPECT_EQ(deck.model.contacts.at(0, 0).kn, 55000.0);
}

TEST(Deck, PrefersAnExplicitPairOverMixing) {
  const Deck deck = parse_edited(
      {{"[[bond]]",
        "[[pair]]\nmaterials = [\"duct\", \"soil\"]\nnormal_stiffness = 1000.0\n[[bond]]"}});

  EXPECT_EQ(soil_duct(deck).kn, 1000.0);
  EXPECT_EQ(deck.model.contacts.at(1, 0).kn, 1000.0);
}

TEST(Deck, TurnsRestitutionIntoTheDashpotThatReboundsWithItUnderTheClampOfTheRun) {
  for (const bool no_tension : {true, false}) {
    const Deck deck = parse_edited(
        {{"friction = 0.5", "restitution = 0.5"},
         {"[[bond]]", fmt::format("[contact]\nno_tension = {}\n[[bond]]", no_tension)}});

    const ContactConstants& law = deck.model.contacts.at(0, 0);
    const double zeta = law.cn.critical / (2.0 * std::sqrt(55000.0));
    EXPECT_NEAR(restitution_at(zeta, no_tension), 0.5, 1e-14);
    EXPECT_EQ(law.restitution, 0.5);
    EXPECT_FALSE(law.is_mixed);
    EXPECT_EQ(law.ct.critical, 0.0);
  }
}

TEST(Deck, MixesTheRestitutionItself) {
  const Deck deck = parse_edited(
      {{"friction = 0.5", "restitution = 0.9"}, {"friction = 0.6", "restitution = 0.1"}});

  const ContactConstants& law = soil_duct(deck);
  EXPECT_NEAR(law.restitution.value(), 0.3, 1e-15);
  EXPECT_TRUE(law.is_mixed);
  EXPECT_NEAR(restitution_at(law.cn.critical / (2.0 * std::sqrt(law.kn)), true), 0.3, 1e-14);
}

TEST(Deck, TakesRestitutionOneAsNoDamping) {
  const Deck deck = parse_edited({{"friction = 0.5", "restitution = 1.0"}});

  EXPECT_EQ(deck.model.contacts.at(0, 0).cn.critical, 0.0);
}

TEST(Deck, AsksForNoConstantsOfAMaterialOfWallsAlone) {
  const Deck deck = parse_edited(
      {{"[[bond]]",
        "[[material]]\nname = \"glass\"\ndensity = 1.0\n"
        "[[pair]]\nmaterials = [\"glass\", \"soil\"]\nnormal_stiffness = 1.0\n"
        "[[pair]]\nmaterials = [\"glass\", \"duct\"]\nnormal_stiffness = 2.0\n[[bond]]"},
       {"normal = [0.0, 2.0]\nmaterial = \"soil\"", "normal = [0.0, 2.0]\nmaterial = \"glass\""}});

  EXPECT_EQ(deck.model.contacts.at(2, 1).kn, 2.0);
}

TEST(Deck, ReadsAPackingWithItsHole) {
  const Deck deck = parse_deck(good_deck(), "test.toml");

  const auto& packing = std::get<PackingSource>(deck.sources[0].kind);
  EXPECT_EQ(packing.count, 1000);
  EXPECT_EQ(packing.sizes.min_radius(), 0.04);
  EXPECT_EQ(packing.sizes.max_radius(), 0.06);
  EXPECT_EQ(packing.holes.at(0).radius, 0.6);
  EXPECT_EQ(deck.sources[0].material, 0);
  EXPECT_EQ(deck.sources[0].place.line, 30);
}

TEST(Deck, LetsTheDisksOfARingJustTouch) {
  const Deck deck = parse_deck(good_deck(), "test.toml");

  const auto& ring = std::get<RingSource>(deck.sources[1].kind);
  EXPECT_NEAR(ring.disk_radius, 0.45 * std::sin(std::numbers::pi / 24.0), 1e-15);
  EXPECT_EQ(deck.sources[1].bond, 0);
}

TEST(Deck, ReadsRadiiAsClassesWithWeights) {
  const Deck deck = parse_edited(
      {{"radius = [0.04, 0.06]", "radius = [{ radius = 0.04, weight = 3.0 }, { radius = 0.06 }]"}});

  const auto& sizes = std::get<PackingSource>(deck.sources[0].kind).sizes;
  ASSERT_EQ(sizes.classes.size(), 2u);
  EXPECT_EQ(sizes.classes[0].weight, 3.0);
  EXPECT_EQ(sizes.classes[1].weight, 1.0);
}

TEST(Deck, SpacesALatticeByTheLargestDiameter) {
  const Deck deck = parse_edited({{"kind = \"packing\"", "kind = \"lattice\""},
                                  {"count = 1000\n", ""},
                                  {"holes = [{ center = [5.0, 1.5], radius = 0.6 }]\n", ""},
                                  {"center = [5.0, 1.5]", "center = [5.0, 4.0]"}});

  const auto& lattice = std::get<LatticeSource>(deck.sources[0].kind);
  EXPECT_EQ(lattice.arrangement, LatticeSource::Arrangement::Square);
  EXPECT_EQ(lattice.spacing, 0.12);
}

TEST(Deck, TakesParticleFilesFromTheFolderOfTheDeck) {
  const std::string ring = "kind = \"ring\"\ncenter = [5.0, 1.5]\nradius = 0.45\ncount = 24\n";
  const std::string text =
      deck_test::edited(good_deck(), {{ring, "kind = \"file\"\npath = \"more.data\"\n"}});

  const Deck deck = parse_deck(text, "decks/test.toml");

  const auto& file = std::get<FileSource>(deck.sources[1].kind);
  EXPECT_EQ(file.path, "decks/more.data");
  EXPECT_TRUE(file.has_sphere_density);
}

TEST(Deck, LetsEachParticleOfAListOverrideItsSource) {
  const std::string ring = "kind = \"ring\"\ncenter = [5.0, 1.5]\nradius = 0.45\ncount = 24\n";
  const Deck deck = parse_edited({{ring, R"(kind = "list"
velocity = [1.0, 0.0]
particle = [{ position = [1.0, 4.0], radius = 0.1 },
            { position = [2.0, 4.0], radius = 0.1, velocity = [0.0, 0.0],)"
                                         R"( omega = 3.0, material = "soil" }]
)"}});

  const auto& list = std::get<ListSource>(deck.sources[1].kind);
  EXPECT_EQ(list.particles.at(0).velocity.x(), 1.0);
  EXPECT_EQ(list.particles.at(0).type, 1);
  EXPECT_EQ(list.particles.at(0).density, 250.0);
  EXPECT_EQ(list.particles.at(1).velocity.x(), 0.0);
  EXPECT_EQ(list.particles.at(1).omega.z(), 3.0);
  EXPECT_EQ(list.particles.at(1).density, 126.0);
}

TEST(Deck, FixesAllParticlesOrThoseInABox) {
  const Deck all = parse_edited({{"bond = \"pipe\"", "fixed = true"}});
  const Deck some =
      parse_edited({{"bond = \"pipe\"", "fixed = { lo = [4.0, 1.0], hi = [6.0, 1.2] }"}});

  EXPECT_TRUE(std::isinf(all.sources[1].fixed->hi.x()));
  EXPECT_EQ(some.sources[1].fixed->hi.y(), 1.2);
  EXPECT_FALSE(some.sources[0].fixed.has_value());
}

TEST(Deck, LoadsAPlateFromANamedStage) {
  const Deck deck = parse_edited({{"[[particles]]", R"([[stage]]
name = "load"
[[wall]]
name = "plate"
kind = "plate"
point = [5.0, 4.0]
normal = [0.0, -1.0]
width = 2.0
material = "soil"
load = 100.0
mass = 10.0
from_stage = "load"
[[particles]])"}});

  const WallSpec& plate = deck.model.walls.at(1);
  EXPECT_EQ(plate.kind, WallKind::Plate);
  EXPECT_TRUE(plate.is_loaded);
  EXPECT_EQ(plate.from_stage, 1);
}

}  // namespace
}  // namespace barchan
