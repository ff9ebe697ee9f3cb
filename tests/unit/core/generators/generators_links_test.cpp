// Which particles a source bonds.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/core/model/digest.hpp>

#include <support/temporary_folder.hpp>

#include <unit/core/deck_text.hpp>

namespace barchan {
namespace {

Model model_of() {
  Model model;
  model.dimension = 2;
  model.domain.hi = Vec3(10, 10, 0);
  model.materials = {{"soil", 126.0}};
  model.bond_laws = {{"glue"}, {"cement"}};
  return model;
}

/// Disks of radius 0.1 in a row along x, with a gap of 0.01 between their surfaces.
ParticleSource row_of(int count) {
  ListSource list;
  for (int i = 0; i < count; ++i)
    list.particles.push_back({0, 0, 0.1, 1.0, {1.0 + 0.21 * i, 5, 0}, Vec3::Zero(), Vec3::Zero()});
  ParticleSource source;
  source.bond = 0;
  source.links.place = {"deck.toml", 9, 8};
  source.kind = list;
  return source;
}

std::string message_of(const std::vector<ParticleSource>& sources) {
  try {
    (void)make_particles(model_of(), sources);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(LinkBonds, RefusesASourceThatLinksNothing) {
  const std::string message = message_of({row_of(4)});

  EXPECT_NE(message.find("deck.toml:9:8: bond = \"glue\" links nothing"), std::string::npos)
      << message;
  EXPECT_NE(message.find("a gap of 0.01 m"), std::string::npos) << message;
  EXPECT_NE(message.find("bond_gap"), std::string::npos) << message;
}

TEST(LinkBonds, LinksAcrossAGap) {
  ParticleSource source = row_of(4);
  source.links.gap = 0.0101;
  EXPECT_EQ(make_particles(model_of(), std::vector{source}).bonds.size(), 3u);

  source.links.gap = 0.0099;
  EXPECT_NE(message_of({source}).find("links nothing"), std::string::npos);
}

TEST(LinkBonds, LinksThePairsOfTheDeckAlsoBetweenSources) {
  ParticleSource second = row_of(2);
  for (ParticleData& p : std::get<ListSource>(second.kind).particles) p.position.y() = 7.0;
  ParticleSource first = row_of(4);
  first.bond.reset();
  second.bond = 1;
  second.links.pairs = {{6, 1}, {5, 6}};

  const ParticleSet set = make_particles(model_of(), std::vector{first, second});

  ASSERT_EQ(set.bonds.size(), 2u);
  EXPECT_EQ(set.bonds[0].id_a, 1);
  EXPECT_EQ(set.bonds[0].id_b, 6);
  EXPECT_EQ(set.bonds[0].law, 1);
  check_particles(model_of(), set);
  second.links.pairs = {{6, 7}};
  EXPECT_NE(message_of({first, second}).find("no particle 7"), std::string::npos);
  second.links.pairs = {{6, 1}, {1, 6}};
  EXPECT_NE(message_of({first, second}).find("deck.toml:9:8: bond_pairs links 1 and 6 twice"),
            std::string::npos);
}

TEST(CheckParticles, LooksAtLengthsAndForcesOfBonds) {
  ParticleSource source = row_of(2);
  source.links.gap = 0.1;
  const ParticleSet good = make_particles(model_of(), std::vector{source});
  EXPECT_NO_THROW(check_particles(model_of(), good));
  const auto refuses = [&](auto&& spoil) {
    ParticleSet set = good;
    spoil(set.bonds.at(0));
    EXPECT_NE(particle_set_hash(set), particle_set_hash(good));
    EXPECT_THROW(check_particles(model_of(), set), InputError);
  };
  refuses([](BondData& bond) { bond.length = -1.0; });
  refuses([](BondData& bond) { bond.shear.x() = std::nan(""); });
  refuses([](BondData& bond) { bond.shear.y() = 1.0; });
  refuses([](BondData& bond) { bond.bending.x() = 1.0; });
  refuses([](BondData& bond) { bond.twisting = 1.0; });
}

class BondsFromFile : public ::testing::Test {
 protected:
  void SetUp() override {
    std::vector<ParticleData> particles = std::get<ListSource>(row_of(4).kind).particles;
    for (std::size_t i = 0; i < particles.size(); ++i)
      particles[i].id = static_cast<std::int64_t>(10 + i);
    write_particles_csv(path_, particles);
    source_.kind = FileSource{path_};
    source_.links.place = {"deck.toml", 9, 8};
  }

  void write_bonds(const std::vector<BondData>& bonds) {
    write_bonds_csv(bonds_path(path_), bonds);
  }

  test::TemporaryFolder folder_;
  std::string path_ = folder_.at("row.csv");
  ParticleSource source_;
};

TEST_F(BondsFromFile, AreLinkedAsTheyAre) {
  write_bonds({{10, 12, 1, 0.5}, {12, 13, 0, 0.2, {1, 0, 0}}});

  ParticleSet set = make_particles(model_of(), std::vector{source_});

  check_particles(model_of(), set);
  ASSERT_EQ(set.bonds.size(), 2u);
  EXPECT_EQ(set.bonds[0].id_b, 12);
  EXPECT_EQ(set.bonds[0].law, 1);
  EXPECT_EQ(set.bonds[0].length, 0.5);
  EXPECT_EQ(set.bonds[1].shear, Vec3(1, 0, 0));

  source_.bond = 0;
  set = make_particles(model_of(), std::vector{source_});
  ASSERT_EQ(set.bonds.size(), 2u);
  EXPECT_EQ(set.bonds[0].law, 0);
}

TEST_F(BondsFromFile, NeedALawAndLeaveNoRoomForOthers) {
  write_bonds({{10, 12, 2}});
  EXPECT_NE(message_of({source_}).find("is of type 3 (the deck has 2 [[bond]] tables"),
            std::string::npos)
      << message_of({source_});
  source_.bond = 0;
  source_.links.gap = 0.1;
  EXPECT_NE(message_of({source_}).find("bond_gap for a file that has bonds"), std::string::npos);
  source_.links.gap.reset();
  write_bonds({});
  EXPECT_NE(message_of({source_}).find("deck.toml:9:8: the file says that there are no bonds"),
            std::string::npos)
      << message_of({source_});
}

TEST(BoxOfAFile, IsComparedWithTheDomain) {
  const test::TemporaryFolder folder;
  const auto particles = std::get<ListSource>(row_of(2).kind).particles;
  std::vector<ParticleData> numbered = particles;
  numbered[0].id = 1, numbered[1].id = 2;
  ParticleSource source;
  source.kind = FileSource{folder.at("a.data")};
  const auto notes = [&](const Box& box, bool is_periodic) {
    write_particles_lammps(folder.at("a.data"), numbered, {}, {box, 2, true, false});
    Model model = model_of();
    model.domain.periodic[0] = is_periodic;
    return make_particles(model, std::vector{source}).notes;
  };

  EXPECT_TRUE(notes({Vec3(0, 0, 0), Vec3(10, 10, 0)}, true).empty());
  const auto other = notes({Vec3(0, 0, 0), Vec3(9, 10, 0)}, false);
  ASSERT_EQ(other.size(), 1u);
  EXPECT_EQ(other[0],
            folder.at("a.data") + ": its box is 0 … 9 × 0 … 10 m, the domain 0 … 10 × 0 … 10 m");
  EXPECT_NE(notes({Vec3(0, 0, 0), Vec3(9, 10, 0)}, true)[0].find("along x, which is periodic"),
            std::string::npos);
}

TEST(DensityOfLammpsData, IsWhatTheDeckSaysNotTheTitle) {
  const test::TemporaryFolder folder;
  const std::string rest =
      "\n\n1 atoms\n1 atom types\n\n0 10 xlo xhi\n0 10 ylo yhi\n-0.1 0.1 zlo zhi\n\nAtoms # "
      "sphere\n\n"
      "1 1 0.02 2500 0.5 0.5 0\n";
  ParticleSource source;
  for (const char* title : {"LAMMPS data file", "# LIGGGHTS data made by a script"}) {
    OutputFile file(folder.at("a.data"));
    file.write(title + rest);
    file.commit();
    source.kind = FileSource{folder.at("a.data"), true};
    EXPECT_NEAR(make_particles(model_of(), std::vector{source}).particles[0].density,
                2500 * 4.0 / 3.0 * 0.01, 1e-12);
    source.kind = FileSource{folder.at("a.data"), false};
    EXPECT_EQ(make_particles(model_of(), std::vector{source}).particles[0].density, 2500);
  }
}

TEST(DeckLinks, AreReadAndChecked) {
  using deck_test::error_of;
  const std::string bond = "bond = \"pipe\"";
  const Deck gap = deck_test::parse_edited({{bond, bond + "\nbond_gap = 0.01"}});
  EXPECT_EQ(gap.sources[1].links.gap, 0.01);
  const Deck pairs = deck_test::parse_edited({{bond, bond + "\nbond_pairs = [[1, 2], [7, 3]]"}});
  ASSERT_EQ(pairs.sources[1].links.pairs.size(), 2u);
  EXPECT_EQ(pairs.sources[1].links.pairs[1], (std::pair<std::int64_t, std::int64_t>(7, 3)));

  EXPECT_NE(error_of({{bond, "bond_gap = 0.01"}}).find("bond_gap without bond"), std::string::npos);
  EXPECT_NE(error_of({{bond, bond + "\nbond_gap = 0.1\nbond_pairs = [[1, 2]]"}}).find("has both"),
            std::string::npos);
  for (const char* wrong : {"[]", "[1, 2]", "[[1]]", "[[1, 1]]", "[[0, 1]]", "[[1, 2.5]]", "3"})
    EXPECT_NE(error_of({{bond, bond + "\nbond_pairs = " + wrong}}), "") << wrong;
  EXPECT_NE(error_of({{bond, bond + "\nbond_pairs = []"}}).find("has no pair"), std::string::npos);
  const std::string kind = "kind = \"file\"\npath = \"";
  const std::string list =
      "kind = \"packing\"\nregion = { lo = [0.0, 0.0], hi = [10.0, 3.0] }\nradius = [0.04, "
      "0.06]\ncount = 1000\nholes = [{ center = [5.0, 1.5], radius = 0.6 }]";
  EXPECT_EQ(error_of({{list, kind + "a.data\"\ndata_density = \"disk\""}}), "");
  EXPECT_NE(error_of({{list, kind + "a.csv\"\ndata_density = \"disk\""}}).find("it is for LAMMPS"),
            std::string::npos);
}

}  // namespace
}  // namespace barchan
