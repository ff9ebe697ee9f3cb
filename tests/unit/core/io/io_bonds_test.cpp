// Bonds in files: they come back bit for bit in every format.
#include <gtest/gtest.h>

#include <filesystem>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/text_file.hpp>

#include <support/temporary_folder.hpp>

namespace barchan {
namespace {

std::vector<ParticleData> three_particles() {
  std::vector<ParticleData> particles;
  for (int i = 1; i <= 3; ++i)
    particles.push_back({i, 0, 0.05, 1000, {0.1 * i, 0.5, 0}, Vec3::Zero(), Vec3::Zero()});
  return particles;
}

std::vector<BondData> two_bonds() {
  return {{1, 2, 0, 1.0 / 7.0, {1.0 / 3.0, 2, 3}, {4, 5, 6e-17}, -1.0 / 9.0}, {2, 3, 1}};
}

void expect_same(const std::vector<BondData>& read, const std::vector<BondData>& written) {
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].id_a, written[i].id_a);
    EXPECT_EQ(read[i].id_b, written[i].id_b);
    EXPECT_EQ(read[i].law, written[i].law);
    EXPECT_EQ(read[i].length, written[i].length);
    EXPECT_EQ(read[i].shear, written[i].shear);
    EXPECT_EQ(read[i].bending, written[i].bending);
    EXPECT_EQ(read[i].twisting, written[i].twisting);
  }
}

std::string csv_error(const std::string& text) {
  try {
    (void)parse_bonds_csv(text, "b.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error for: " + text;
}

TEST(BondFiles, ComeBackBitForBit) {
  const test::TemporaryFolder folder;
  const auto particles = three_particles();
  const auto bonds = two_bonds();
  write_particles_csv(folder.at("a.csv"), particles);
  write_bonds_csv(folder.at("a_bonds.csv"), bonds);
  write_particles_vtp(folder.at("a.vtp"), particles);
  write_bonds_vtp(folder.at("a_bonds.vtp"), particles, bonds);
  write_particles_lammps(folder.at("a.data"), particles, bonds,
                         {{Vec3(0, 0, 0), Vec3(1, 1, 1)}, 3, true, true});

  for (const char* name : {"a.csv", "a.vtp", "a.data"}) {
    const ParticleFile file = read_particles(folder.at(name));
    EXPECT_TRUE(file.has_bonds) << name;
    EXPECT_EQ(file.particles.size(), 3u) << name;
    expect_same(file.bonds, bonds);
  }
}

TEST(BondFiles, MayTellThatThereAreNone) {
  const test::TemporaryFolder folder;
  const auto particles = three_particles();
  write_particles_csv(folder.at("a.csv"), particles);
  EXPECT_FALSE(read_particles(folder.at("a.csv")).has_bonds);
  write_bonds_csv(folder.at("a_bonds.csv"), {});
  write_particles_vtp(folder.at("a.vtp"), particles);
  write_bonds_vtp(folder.at("a_bonds.vtp"), particles, {});
  write_particles_lammps(folder.at("a.data"), particles, {},
                         {{Vec3(0, 0, 0), Vec3(1, 1, 1)}, 3, true, true});

  for (const char* name : {"a.csv", "a.vtp", "a.data"}) {
    const ParticleFile file = read_particles(folder.at(name));
    EXPECT_TRUE(file.has_bonds) << name;
    EXPECT_TRUE(file.bonds.empty()) << name;
  }
}

TEST(BondFiles, BelongToParticlesOfTheFile) {
  const test::TemporaryFolder folder;
  const std::vector<BondData> bonds{{1, 2, 0}, {3, 8, 0}};
  write_particles_csv(folder.at("a.csv"), three_particles());
  write_bonds_csv(folder.at("a_bonds.csv"), bonds);
  try {
    (void)read_particles(folder.at("a.csv"));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("a_bonds.csv: the bond between particles 3 and 8"),
              std::string::npos)
        << error.what();
  }
}

TEST(BondFiles, OfOneRankLeaveOutWhatLiesElsewhere) {
  const test::TemporaryFolder folder;
  auto particles = three_particles();
  write_bonds_vtp(folder.at("a_bonds.vtp"), particles, two_bonds());
  particles.pop_back();
  write_particles_vtp(folder.at("a.vtp"), particles);

  const ParticleFile file = read_particles(folder.at("a.vtp"));

  EXPECT_EQ(file.bonds.size(), 1u);
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_NE(file.notes[0].find("1 bonds with an end"), std::string::npos);
}

TEST(BondFiles, AreNotTakenForParticles) {
  const test::TemporaryFolder folder;
  write_bonds_vtp(folder.at("a.vtp"), three_particles(), two_bonds());
  EXPECT_THROW((void)read_particles(folder.at("a.vtp")), InputError);
  write_particles_vtp(folder.at("b.vtp"), three_particles());
  EXPECT_THROW((void)parse_bonds_vtp(read_text_file(folder.at("b.vtp")), "b.vtp"), InputError);
}

TEST(BondTables, NeedNoMoreThanIds) {
  const auto bonds = parse_bonds_csv("atom1;atom2\n5;2\n", "b.csv");
  ASSERT_EQ(bonds.size(), 1u);
  EXPECT_EQ(bonds[0].id_a, 2);
  EXPECT_EQ(bonds[0].id_b, 5);
  EXPECT_EQ(bonds[0].length, 0.0);
}

TEST(BondTables, RefuseWhatIsNoBond) {
  EXPECT_NE(csv_error("id_a,type\n1,1\n").find("'id_b' is missing"), std::string::npos);
  EXPECT_NE(csv_error("id_a,id_b\n1,1\n").find("b.csv:2: "), std::string::npos);
  EXPECT_NE(csv_error("id_a,id_b\n0,1\n").find("no valid id"), std::string::npos);
  EXPECT_NE(csv_error("id_a,id_b,length\n1,2,-1\n").find("length"), std::string::npos);
  EXPECT_NE(csv_error("id_a,id_b,twisting\n2,1,1\n").find("not in order"), std::string::npos);
  EXPECT_NE(csv_error("id_a,id_b,lenght\n1,2,1\n").find("did you mean 'length'"),
            std::string::npos);
  EXPECT_NE(csv_error("").find("is missing"), std::string::npos);
}

TEST(BondFiles, StandBesideTheirParticles) {
  EXPECT_EQ(bonds_path("a/b.csv"), "a/b_bonds.csv");
  EXPECT_EQ(bonds_path("a.b/c.csv.gz"), "a.b/c_bonds.csv.gz");
}

}  // namespace
}  // namespace barchan
