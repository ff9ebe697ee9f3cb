#include <barchan/core/deck/deck.hpp>

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <unit/core/deck_text.hpp>

namespace barchan {
namespace {

using deck_test::error_of;

/// One way to spoil the good deck, and what the message must say.
struct Fault {
  const char* name;
  std::string from, to;
  std::vector<std::string> parts;
};

std::ostream& operator<<(std::ostream& stream, const Fault& fault) {
  return stream << fault.name;
}

class DeckFault : public testing::TestWithParam<Fault> {};

TEST_P(DeckFault, IsRefusedWithPlaceAndRemedy) {
  const std::string message = error_of({{GetParam().from, GetParam().to}});

  for (const std::string& part : GetParam().parts) {
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' in '" << message << "'";
  }
  EXPECT_EQ(message.rfind("test.toml:", 0), 0u) << message;
}

std::string name_of(const testing::TestParamInfo<Fault>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    Keys, DeckFault,
    testing::Values(
        Fault{"MisspeltKey",
              "normal_stiffness",
              "normal_stifness",
              {":12:1:", "unknown key 'normal_stifness' in [[material]]",
               "did you mean 'normal_stiffness'?"}},
        Fault{"MisspeltTable",
              "[domain]",
              "[domian]",
              {":3:2:", "'domian'", "did you mean 'domain'?"}},
        Fault{"KeyOfAnotherKind",
              "count = 24",
              "count = 24\nseed = 1",
              {":42:1:", "'seed'", "key of lattice"}},
        Fault{"MissingKey",
              "step = 1e-4\n",
              "",
              {":6:1:", "[time] lacks the key 'step'", "number > 0 in s"}},
        Fault{"MissingTable",
              "[time]\nstep = 1e-4\nend = 2.0\n",
              "",
              {":1:1:", "the deck lacks the key 'time'"}},
        Fault{"MissingRunLength", "end = 2.0\n", "", {":6:1:", "when the run ends", "add end"}},
        Fault{
            "BothRunLengths", "end = 2.0", "end = 2.0\nsteps = 5", {":9:9:", "both end and steps"}},
        Fault{
            "MissingKind", "kind = \"ring\"\n", "", {":37:1:", "lacks the key 'kind'", "packing"}},
        Fault{
            "UnknownKind", "\"ring\"", "\"rnig\"", {":38:8:", "\"rnig\"", "did you mean 'ring'?"}},
        Fault{"MissingMaterialOfSource",
              "material = \"duct\"\n",
              "",
              {":37:1:", "lacks the key 'material'"}},
        Fault{"NoToml", "step = 1e-4", "step = = 1", {":7:", "not TOML"}},
        Fault{"LetterBeyondAscii", "step = 1e-4", "step = \u03da", {":7:", "beyond ASCII"}},
        Fault{"HeaderWithoutName", "[[bond]]", "[[%]]", {":19:", "not TOML"}},
        Fault{"DeepKey",
              "gravity = ",
              "a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a = ",
              {":2:", "more than 16 parts"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Values, DeckFault,
    testing::Values(
        Fault{"StringForNumber",
              "55000.0",
              "\"55000\"",
              {":12:20:", "expected a number, found a string"}},
        Fault{"NumberForString",
              "name = \"soil\"",
              "name = 3",
              {":10:8:", "expected a string, found an integer"}},
        Fault{"NumberForInteger",
              "count = 1000",
              "count = 1.5",
              {":34:9:", "count = 1.5 is not a whole number", "1e3"}},
        Fault{"NumberForVector",
              "gravity = [0.0, -9.81]",
              "gravity = -9.81",
              {":2:11:", "expected an array"}},
        Fault{"TableForTables",
              "[[bond]]",
              "[bond]",
              {":19:1:", "expected an array of tables", "[[bond]]"}},
        Fault{"NumberForTable",
              "[domain]\nlo = [0.0, 0.0]\nhi = [10.0, 5.0]",
              "domain = 3",
              {":3:10:", "expected a table, found an integer"}},
        Fault{"TooManyComponents",
              "[0.0, -9.81]",
              "[0.0, 0.0, -9.81]",
              {":2:11:", "3 numbers, expected 2"}},
        Fault{"NanCoordinate",
              "point = [0.0, 0.0]",
              "point = [0.0, nan]",
              {":24:15:", "point is not finite"}},
        Fault{"InfiniteStep", "step = 1e-4", "step = inf", {":7:8:", "step is not finite"}},
        Fault{
            "ZeroStep", "step = 1e-4", "step = 0.0", {":7:8:", "out of range", "number > 0 in s"}},
        Fault{"TinyStep", "step = 1e-4", "step = 1e-300", {":8:7:", "steps"}},
        Fault{"NegativeRadius",
              "radius = 0.45",
              "radius = -0.45",
              {":40:10:", "radius = -0.45", "number > 0"}},
        Fault{
            "NegativeRadiusInRange", "[0.04, 0.06]", "[-0.04, 0.06]", {":33:11:", "out of range"}},
        Fault{"ReversedRange",
              "[0.04, 0.06]",
              "[0.06, 0.04]",
              {":33:10:", "empty", "smaller radius first"}},
        Fault{"NegativeStiffness",
              "55000.0",
              "-1.0",
              {":12:20:", "normal_stiffness = -1", "out of range"}},
        Fault{"NegativeDensity", "126.0", "-126.0", {":11:11:", "density = -126"}},
        Fault{"ZeroRestitution", "friction = 0.5", "restitution = 0.0", {":13:15:", "(0, 1]"}},
        Fault{"LargeRestitution", "friction = 0.5", "restitution = 1.1", {":13:15:", "(0, 1]"}},
        Fault{"WrongDimension",
              "dimension = 2",
              "dimension = 4",
              {":1:13:", "2 for disks or 3 for spheres"}},
        Fault{"ZeroNormal", "[0.0, 2.0]", "[0.0, 0.0]", {":25:10:", "zero vector"}},
        Fault{"UnknownAxis",
              "hi = [10.0, 5.0]",
              "hi = [10.0, 5.0]\nperiodic = [\"z\"]",
              {":6:12:", "'z' is not an axis"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Names, DeckFault,
    testing::Values(
        Fault{"UnknownMaterial",
              "material = \"duct\"",
              "material = \"dutc\"",
              {":42:12:", "unknown material 'dutc'", "did you mean 'duct'?"}},
        Fault{"UnknownBond",
              "bond = \"pipe\"",
              "bond = \"pip\"",
              {":43:8:", "unknown bond", "did you mean 'pipe'?"}},
        Fault{"UnknownStage",
              "normal = [0.0, 2.0]",
              "normal = [0.0, 2.0]\nfrom_stage = \"sett\"",
              {":26:14:", "unknown stage 'sett'", "did you mean 'settle'?"}},
        Fault{"TwoMaterialsOfOneName",
              "name = \"duct\"",
              "name = \"soil\"",
              {":15:8:", "second material", "first stands in line 10"}},
        Fault{"MissingPair",
              "normal_stiffness = 65000.0\nfriction = 0.6\n",
              "",
              {":15:8:", "missing material pair", "'soil' and 'duct'", "add a [[pair]]"}},
        Fault{"UnmixedPair",
              "[[bond]]",
              "[contact]\nmixing = \"none\"\n[[bond]]",
              {"missing material pair"}},
        Fault{"TwoPairsOfOneKind",
              "[[bond]]",
              "[[pair]]\nmaterials = [\"soil\", \"duct\"]\nnormal_stiffness = 1.0\n"
              "[[pair]]\nmaterials = [\"duct\", \"soil\"]\nnormal_stiffness = 1.0\n[[bond]]",
              {":23:13:", "second [[pair]]"}},
        Fault{"ConstantsWithoutStiffness",
              "normal_stiffness = 65000.0\n",
              "",
              {":17:12:", "friction without normal_stiffness"}},
        Fault{"TwoDampings",
              "friction = 0.5",
              "restitution = 0.5\nnormal_damping = 1.0",
              {":13:15:", "both normal_damping and restitution"}},
        Fault{"RestitutionBesideACoefficient",
              "friction = 0.5\n[[material]]\nname = \"duct\"\ndensity = 250.0\n",
              "restitution = 1.0\n[[material]]\nname = \"duct\"\ndensity = 250.0\n"
              "normal_damping = 5.0\n",
              {":15:8:", "'soil' and 'duct'", "different ways", "both a restitution"}},
        Fault{"TooManyMaterials",
              "[[bond]]",
              [] {
                std::string text;
                for (int m = 0; m < 21; ++m)
                  text += "[[material]]\nname = \"m" + std::to_string(m) + "\"\ndensity = 1.0\n";
                return text + "[[bond]]";
              }(),
              {"23 materials", "1 to 22"}},
        Fault{"WarningBeyondTheError",
              "[[bond]]",
              "[limits]\noverlap_warning = 0.9\noverlap_error = 0.5\n[[bond]]",
              {":20:19:", "overlap_warning = 0.9 is beyond overlap_error = 0.5"}},
        Fault{"TooManyCheckpointsKept",
              "[[bond]]",
              "[checkpoint]\nkeep = 99999999999\n[[bond]]",
              {":20:8:", "out of range", "1 to 1000"}},
        Fault{"EndlessStage",
              "max_time = 1.0",
              "[[stage]]\nname = \"load\"",
              {":28:8:", "never ends"}},
        Fault{"BondWithoutStiffness", "young_modulus = 1e6\n", "", {":20:8:", "no stiffness"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Ground, DeckFault,
    testing::Values(
        Fault{"EmptyDomain",
              "hi = [10.0, 5.0]",
              "hi = [0.0, 5.0]",
              {":5:6:", "the domain is empty", "along x"}},
        Fault{"EmptyRegion",
              "hi = [10.0, 3.0]",
              "hi = [10.0, 0.0]",
              {":32:", "the region is empty", "along y"}},
        Fault{"RegionOutside",
              "hi = [10.0, 3.0]",
              "hi = [10.0, 9.0]",
              {":32:10:", "outside the domain", "along y"}},
        Fault{"RingOutside",
              "center = [5.0, 1.5]\nradius = 0.45",
              "center = [9.9, 4.0]\nradius = 0.45",
              {":39:10:", "the ring lies outside the domain"}},
        Fault{"RingInPacking",
              "radius = 0.6 }",
              "radius = 0.4 }",
              {":37:1:", "overlap", "line 30", "holes"}},
        Fault{"ThinRegion", "hi = [10.0, 3.0]", "hi = [10.0, 0.1]", {":32:10:", "too thin"}},
        Fault{"Overfull", "count = 1000", "count = 100000", {":34:9:", "times the region"}},
        Fault{"NoAmount", "count = 1000\n", "", {":30:1:", "how many particles", "solid_fraction"}},
        Fault{"TooManyParticles",
              "[0.04, 0.06]\ncount = 1000",
              "1e-9\nsolid_fraction = 0.5",
              {":34:18:", "at most 2e9"}},
        Fault{"TwoBoxes",
              "kind = \"ring\"\ncenter = [5.0, 1.5]\nradius = 0.45\ncount = 24",
              "kind = \"lattice\"\nradius = 0.05\nregion = { lo = [9.0, 2.0], hi = [10.0, 4.0] }",
              {":37:1:", "overlap", "line 30"}},
        Fault{"OverlappingLattice",
              "kind = \"ring\"\ncenter = [5.0, 1.5]\nradius = 0.45\ncount = 24",
              "kind = \"lattice\"\nradius = 0.05\nspacing = 0.09\nregion = { lo = [9.0, 4.0], hi = "
              "[10.0, 5.0] }",
              {":40:11:", "overlap at a spacing"}},
        Fault{"UnknownFileFormat",
              "kind = \"ring\"\ncenter = [5.0, 1.5]\nradius = 0.45\ncount = 24",
              "kind = \"file\"\npath = \"grains.xyz\"",
              {":39:8:", ".csv"}},
        Fault{"PlaneWithLoad",
              "normal = [0.0, 2.0]",
              "normal = [0.0, 2.0]\nload = 1.0",
              {":26:8:", "load on a plane"}},
        Fault{"PlateWithoutWidth",
              "normal = [0.0, 2.0]",
              "normal = [0.0, 2.0]\nkind = \"plate\"",
              {"width"}}),
    name_of);

TEST(DeckErrors, NameAnUnreadableFile) {
  for (const char* path : {"no/such/deck.toml", "."}) {
    try {
      (void)read_deck(path);
      FAIL() << path;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("cannot read this deck"), std::string::npos);
    }
  }
}

TEST(DeckErrors, AreTheOnlyAnswerToCutOffDecks) {
  const std::string good = deck_test::good_deck();

  for (std::size_t length = 0; length < good.size(); ++length) {
    EXPECT_NO_FATAL_FAILURE((void)error_of(good.substr(0, length))) << length;
  }
}

}  // namespace
}  // namespace barchan
