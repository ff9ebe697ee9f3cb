#include <barchan/core/model/source_record.hpp>

#include <gtest/gtest.h>

#include <functional>

#include <barchan/core/checkpoint/manifest.hpp>
#include <barchan/core/deck/deck.hpp>
#include <barchan/core/generators/make_particles.hpp>

#include <unit/core/deck_text.hpp>

namespace barchan {
namespace {

using deck_test::Edit;
using deck_test::edited;
using deck_test::good_deck;

std::vector<SourceRecord> records_of(std::initializer_list<Edit> edits) {
  const Deck deck = parse_deck(
      edited(edited(good_deck(), {{"count = 1000", "count = 100"}}), edits), "deck.toml");
  std::vector<std::size_t> begins;
  const ParticleSet made = make_particles(deck.model, deck.sources, begins);
  return make_records(deck.sources, made, begins);
}

std::string difference_of(std::initializer_list<Edit> edits) {
  return source_differences(records_of({}), records_of(edits));
}

TEST(SourceRecord, IsTheSameForTheSameParticles) {
  EXPECT_EQ(difference_of({}), "");
  EXPECT_EQ(difference_of({{"radius = 0.45", "radius = 45e-2"}}), "");
  EXPECT_EQ(difference_of({{"count = 24\n", "count = 24\nstart_angle = 0\n"}}), "");
  EXPECT_EQ(difference_of({{"young_modulus = 1e6", "young_modulus = 2e6"}}), "");
  EXPECT_EQ(difference_of({{"\"pipe\"", "\"tube\""}, {"\"pipe\"", "\"tube\""}}), "");
}

TEST(SourceRecord, TakesLengthsAndForcesOfAFilesBondsIn) {
  Deck deck = parse_deck(edited(good_deck(), {{"count = 1000", "count = 100"}}), "deck.toml");
  for (ParticleSource& source : deck.sources) source.record.keys.push_back({"path", "beam.vtp"});
  std::vector<std::size_t> begins;
  const ParticleSet made = make_particles(deck.model, deck.sources, begins);
  ASSERT_FALSE(made.bonds.empty());
  const auto of = [&](const ParticleSet& set) { return make_records(deck.sources, set, begins); };
  ParticleSet longer = made, bent = made;
  longer.bonds[0].length += 1e-3;
  bent.bonds[0].bending[2] = 1.0;

  EXPECT_EQ(source_differences(of(made), of(made)), "");
  EXPECT_NE(source_differences(of(made), of(longer)), "");
  EXPECT_NE(source_differences(of(made), of(bent)), "");
}

TEST(SourceRecord, NamesTheKeysThatDiffer) {
  EXPECT_EQ(difference_of({{"count = 100", "count = 99"}}),
            "[[particles]] 1 (packing, line 30): count was 100 and is 99");
  EXPECT_EQ(
      difference_of({{"count = 24", "count = 25\nomega = 1"}}),
      "[[particles]] 2 (ring, line 37): count was 24 and is 25, omega was not given and is 1");
  EXPECT_EQ(difference_of({{"bond = \"pipe\"\n", ""}}),
            "[[particles]] 2 (ring, line 37): bond was \"pipe\" and is not given");
  EXPECT_NE(difference_of({{"radius = 0.6 }", "radius = 0.7 }"}})
                .find("holes.1.radius was 0.6 and is 0.7"),
            std::string::npos);
}

TEST(SourceRecord, NamesTablesThatWereAddedOrAreGone) {
  const auto two = records_of({});
  const std::vector<SourceRecord> ring{two[1]};

  EXPECT_EQ(source_differences(two, ring), "[[particles]] 1 (packing) of the checkpoint is gone");
  EXPECT_EQ(source_differences(ring, two), "[[particles]] 1 (packing, line 30) was added");
  EXPECT_EQ(source_differences(std::vector{two[0]}, two),
            "[[particles]] 2 (ring, line 37) was added");
  EXPECT_EQ(source_differences({}, two), "");  // particles of a program have no records
}

TEST(SourceRecord, TakesOtherRoundingOfAGeneratorForTheSame) {
  auto other = records_of({});
  other[1].hash += 1;
  EXPECT_EQ(source_differences(records_of({}), other), "");

  for (SourceRecord& record : other) record.keys.push_back({"path", "\"some.csv\""});
  auto saved = other;
  saved[1].hash += 1;
  EXPECT_EQ(source_differences(saved, other),
            "[[particles]] 2 (ring, line 37): the contents of \"some.csv\" differ");
}

/// The hash of a source of two particles and a bond, changed in one way.
std::uint64_t hash_with(const std::function<void(ParticleSet&)>& change) {
  ParticleSet set;
  set.particles.resize(2);
  set.particles[0].id = 1, set.particles[1].id = 2;
  set.bonds = {{1, 2, 0}};
  change(set);
  const std::vector<ParticleSource> sources(1);
  return make_records(sources, set, std::vector<std::size_t>{0, 2})[0].hash;
}

TEST(SourceRecord, SeesEveryNumberOfAParticleAndOfABond) {
  const std::vector<std::function<void(ParticleSet&)>> changes{
      [](ParticleSet&) {},
      [](ParticleSet& s) { s.particles[1].id = 3; },
      [](ParticleSet& s) { s.particles[1].type = 1; },
      [](ParticleSet& s) { s.particles[1].radius = 1.0; },
      [](ParticleSet& s) { s.particles[1].density = 1.0; },
      [](ParticleSet& s) { s.particles[1].position[2] = 1.0; },
      [](ParticleSet& s) { s.particles[1].velocity[1] = 1.0; },
      [](ParticleSet& s) { s.particles[1].omega[0] = 1.0; },
      [](ParticleSet& s) { s.particles[1].fixed = true; },
      [](ParticleSet& s) { s.bonds[0].id_b = 3; },
      [](ParticleSet& s) { s.bonds[0].law = 1; },
      [](ParticleSet& s) { s.bonds.clear(); }};
  std::vector<std::uint64_t> hashes;
  for (const auto& change : changes) {
    hashes.push_back(hash_with(change));
    for (std::size_t n = 0; n + 1 < hashes.size(); ++n)
      EXPECT_NE(hashes[n], hashes.back()) << n << " and " << hashes.size() - 1;
  }
}

TEST(SourceRecord, TravelsInAManifest) {
  Manifest manifest{5, 0.1, 2, "a run", {{{64, 1}, 0, 3, 20, 5, 2, 1}}, records_of({})};

  const Manifest read = parse_manifest(manifest_text(manifest), "file");

  ASSERT_EQ(read.sources.size(), 2U);
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_EQ(read.sources[s].kind, manifest.sources[s].kind);
    EXPECT_EQ(read.sources[s].keys, manifest.sources[s].keys);
    EXPECT_EQ(read.sources[s].hash, manifest.sources[s].hash);
  }
}

}  // namespace
}  // namespace barchan
