// LAMMPS data files beyond the plain ones of io_particles_test.cpp.
#include <gtest/gtest.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/particle_file.hpp>

#include <support/temporary_folder.hpp>

namespace barchan {
namespace {

constexpr const char* kHeader =
    "title\n\n2 atoms\n1 bonds\n1 atom types\n1 bond types\n2 extra bond per atom\n\n"
    "0 1 xlo xhi\n0 1 ylo yhi\n-0.1 0.1 zlo zhi\n0 0 0 xy xz yz\n\n";
constexpr const char* kAtoms =
    "Atoms # bpm/sphere\n\n1 1 1 0.1 2500 0.2 0.5 0\n2 7 1 0.1 2500 0.3 0.5 0 0 0 1\n\n";
constexpr const char* kBonds = "Bonds\n\n1 1 2 1\n";

ParticleFile read(const std::string& text) {
  return parse_particles_lammps(text, "a.data");
}

std::string error_of(const std::string& text) {
  try {
    (void)read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error for: " + text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(LammpsData, HasBondsInStyleBpmSphere) {
  const ParticleFile file = read(std::string(kHeader) + kAtoms + kBonds);

  ASSERT_EQ(file.particles.size(), 2u);
  EXPECT_EQ(file.particles[1].radius, 0.05);
  EXPECT_EQ(file.particles[1].position, Vec3(0.3, 0.5, 0));
  ASSERT_EQ(file.bonds.size(), 1u);
  EXPECT_EQ(file.bonds[0].id_a, 1);
  EXPECT_EQ(file.bonds[0].id_b, 2);
  EXPECT_EQ(file.bonds[0].law, 0);
  EXPECT_EQ(file.bonds[0].length, 0.0);
  EXPECT_TRUE(file.notes.empty());
}

TEST(LammpsData, OfDisksHasTheDensityOfSpheresOfTheSameMass) {
  const test::TemporaryFolder folder;
  const std::vector<ParticleData> disks{
      {1, 0, 0.05, 126.0, {0.2, 0.5, 0}, Vec3::Zero(), Vec3::Zero()}};
  const Box box{Vec3(0, 0, 0), Vec3(1, 1, 0)};
  write_particles_lammps(folder.at("spheres.data"), disks, {}, {box, 2, true, false});
  write_particles_lammps(folder.at("disks.data"), disks, {}, {box, 2, false, false});

  EXPECT_NEAR(read_particles(folder.at("spheres.data")).particles[0].density,
              126.0 / (4.0 / 3.0 * 0.05), 1e-9);
  EXPECT_EQ(read_particles(folder.at("disks.data")).particles[0].density, 126.0);
}

TEST(LammpsData, MayLackItsTitle) {
  const std::string text = std::string(kHeader + 7) + kAtoms + kBonds;
  ASSERT_EQ(text.rfind("2 atoms", 0), 0u);

  EXPECT_EQ(read(text).particles.size(), 2u);
}

TEST(LammpsData, MayNotBeTilted) {
  EXPECT_NE(error_of(replaced(std::string(kHeader) + kAtoms + kBonds, "0 0 0 xy", "0 0.1 0 xy"))
                .find("a.data:12: the box is tilted"),
            std::string::npos);
}

TEST(LammpsData, ListsSectionsThatAreNotUsed) {
  const ParticleFile file =
      read(std::string(kHeader) + "Masses\n\n1 1.0\n\nBond Coeffs # harmonic\n\n1 2 3\n\n" +
           kAtoms + "Angles\n\n1 1 1 2 1\n\n" + kBonds);

  EXPECT_EQ(file.notes, std::vector<std::string>{"sections not used: Masses, Bond Coeffs, Angles"});
}

TEST(LammpsData, SaysThatItTakesRowsWithoutStyleForSpheres) {
  const std::string atoms = "Atoms\n\n1 1 0.1 2500 0.2 0.5 0\n2 1 0.1 2500 0.3 0.5 0\n\n";
  const ParticleFile file = read(std::string(kHeader) + atoms + kBonds);

  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_NE(file.notes[0].find("read as sphere"), std::string::npos);
}

TEST(LammpsData, RefusesStylesWithoutDiametersByName) {
  for (const char* style : {"full", "atomic", "bond", "molecular", "hybrid", "ellipsoid"}) {
    const std::string error =
        error_of(replaced(std::string(kHeader) + kAtoms + kBonds, "bpm/sphere", style));
    EXPECT_NE(error.find("atom style '" + std::string(style) + "'"), std::string::npos) << error;
    EXPECT_NE(error.find("bpm/sphere (id molecule type"), std::string::npos) << error;
  }
}

TEST(LammpsData, RefusesBondsThatCannotBe) {
  const std::string head = std::string(kHeader) + kAtoms;
  EXPECT_NE(error_of(head + "Bonds\n\n1 1 1 3\n").find("unknown id '3'"), std::string::npos);
  EXPECT_NE(error_of(head + "Bonds\n\n1 1 2 2\n").find("itself"), std::string::npos);
  EXPECT_NE(error_of(head + "Bonds\n\n1 0 1 2\n").find("no valid type"), std::string::npos);
  EXPECT_NE(error_of(head + "Bonds\n\n1 1 1 2\n2 1 2 1\n").find("listed twice"), std::string::npos);
  EXPECT_NE(error_of(head + "Bonds\n\n1 1 1\n").find("3 fields"), std::string::npos);
  EXPECT_NE(error_of(head).find("0 rows in Bonds"), std::string::npos);
  EXPECT_NE(error_of(head + "Bonds\n\n1 1 1 2 # length x\n").find("'x'"), std::string::npos);
  EXPECT_NE(error_of(head + "Bonds\n\n1 1 1 2 # length 1 bend 0\n").find("damaged"),
            std::string::npos);
  EXPECT_NE(error_of(std::string(kHeader) + kBonds + kAtoms).find("before Atoms"),
            std::string::npos);
}

TEST(LammpsData, HasAVelocityForEveryParticleOrNone) {
  const std::string text = std::string(kHeader) + kAtoms + kBonds + "\nVelocities\n\n";
  const std::string first = "1 1 2 3 4 5 6\n";

  EXPECT_EQ(read(text + first + "2 0 0 0 0 0 0\n").particles[0].velocity, Vec3(1, 2, 3));
  EXPECT_NE(error_of(text + first).find("1 rows in Velocities"), std::string::npos);
  EXPECT_NE(error_of(text + first + first).find("a second row of Velocities for particle 1"),
            std::string::npos);
}

TEST(LammpsData, TellsADumpByItsFirstLine) {
  EXPECT_NE(error_of("ITEM: TIMESTEP\n0\n").find("a LAMMPS dump"), std::string::npos);
}

}  // namespace
}  // namespace barchan
