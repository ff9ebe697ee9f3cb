#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/text_file.hpp>

#include <support/temporary_folder.hpp>

namespace barchan {
namespace {

constexpr const char* kHeader = "id,type,radius,density,x,y,z,vx,vy,vz,omegax,omegay,omegaz\n";

std::string temporary(const std::string& name) {
  static const test::TemporaryFolder folder;
  return folder.at(name);
}

/// The error of reading `text` as CSV; fails the test when there is none.
InputError csv_error(const std::string& text) {
  try {
    (void)parse_particles_csv(text, "grains.csv");
  } catch (const InputError& error) {
    return error;
  }
  ADD_FAILURE() << "no error for: " << text;
  return InputError("", "");
}

InputError lammps_error(const std::string& text) {
  try {
    (void)parse_particles_lammps(text, "grains.data");
  } catch (const InputError& error) {
    return error;
  }
  ADD_FAILURE() << "no error for: " << text;
  return InputError("", "");
}

std::vector<ParticleData> some_particles() {
  std::vector<ParticleData> particles;
  for (int i = 1; i <= 5; ++i) {
    const double t = i / 3.0;
    particles.push_back(
        {10 - i, i % 2, 0.1 * t, 126.0 / t, {t, -t, 0.5 * t}, {1e-17 * t, t, 0}, {0, 0, -t / 7}});
  }
  return particles;
}

void expect_same(const ParticleData& a, const ParticleData& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.type, b.type);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.density, b.density);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.omega, b.omega);
}

TEST(ParticlesCsv, ReadsColumnsInAnyOrderAndIgnoresOthers) {
  const std::string text =
      "\xEF\xBB\xBF# made by hand\r\n y , x,\"mass\",radius,density,type,id,omegaz\r\n"
      "2,1,oops,0.05,+126,2,7,-3e-1\r\n\r\n4,3,,0.04,126,1,3,0";

  const ParticleFile file = parse_particles_csv(text, "a.csv");

  ASSERT_EQ(file.particles.size(), 2u);
  expect_same(file.particles[0], {7, 1, 0.05, 126, {1, 2, 0}, {0, 0, 0}, {0, 0, -0.3}});
  expect_same(file.particles[1], {3, 0, 0.04, 126, {3, 4, 0}, {0, 0, 0}, {0, 0, 0}});
  EXPECT_EQ(file.lines, (std::vector<std::int64_t>{3, 5}));
  EXPECT_FALSE(file.box);
}

TEST(ParticlesCsv, NamesLineAndColumnOfAMalformedNumber) {
  const InputError error =
      csv_error("id,type,radius,density,x,y\n1,1,0.1,1,0,0\n2,1,0.1,1,4.5q,0\n");

  EXPECT_EQ(error.place().line, 3);
  EXPECT_EQ(error.place().column, 11);
  EXPECT_NE(std::string(error.what()).find("grains.csv:3:11"), std::string::npos) << error.what();
}

TEST(ParticlesCsv, RefusesWhatIsNoParticle) {
  const std::string head = "id,type,radius,density,x,y\n";
  EXPECT_EQ(csv_error(head + "1,1,0.1,1,nan,0\n").place().column, 11);
  EXPECT_EQ(csv_error(head + "1,1,0.1,1,0,inf\n").place().line, 2);
  EXPECT_EQ(csv_error(head + "1,1,0.1,1,0,1e999\n").place().line, 2);
  EXPECT_EQ(csv_error(head + "1,1,-0.1,1,0,0\n").place().line, 2);
  EXPECT_EQ(csv_error(head + "1,1,0,1,0,0\n").place().line, 2);
  EXPECT_EQ(csv_error(head + "1,1,0.1,0,0,0\n").place().line, 2);
  EXPECT_EQ(csv_error(head + "0,1,0.1,1,0,0\n").place().line, 2);
  EXPECT_EQ(csv_error(head + "1,0,0.1,1,0,0\n").place().line, 2);
  EXPECT_EQ(csv_error(head + "1,9999999999,0.1,1,0,0\n").place().line, 2);
  EXPECT_EQ(csv_error(head + "1.5,1,0.1,1,0,0\n").place().line, 2);
  EXPECT_EQ(csv_error(head + "1,1,,1,0,0\n").place().line, 2);
}

TEST(ParticlesCsv, RefusesRowsAndHeadersOfTheWrongShape) {
  const std::string head = "id,type,radius,density,x,y\n";
  EXPECT_NE(std::string(csv_error(head + "1,1,0.1,1,0\n").what()).find("5 fields"),
            std::string::npos);
  EXPECT_NE(std::string(csv_error(head + "1,1,0.1,1,0,0,8\n").what()).find("7 fields"),
            std::string::npos);
  EXPECT_NE(std::string(csv_error("id,type,density,x,y\n").what()).find("'radius' is missing"),
            std::string::npos);
  EXPECT_NE(std::string(csv_error("id,type,radius,density,x,x,y\n").what()).find("twice"),
            std::string::npos);
  EXPECT_NE(std::string(csv_error(head).what()).find("no particles"), std::string::npos);
  EXPECT_NE(std::string(csv_error("").what()).find("no particles"), std::string::npos);
}

TEST(ParticlesCsv, NamesBothLinesOfARepeatedId) {
  const InputError error =
      csv_error("id,type,radius,density,x,y\n5,1,1,1,0,0\n2,1,1,1,9,0\n5,1,1,1,4,0\n");

  EXPECT_EQ(error.place().line, 4);
  EXPECT_NE(std::string(error.what()).find("line 2"), std::string::npos) << error.what();
}

TEST(ParticlesCsv, RefusesFilesThatCannotBeRead) {
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/zero", folder.at("zero.csv"));
  std::filesystem::create_directory(folder.at("folder.csv"));
  EXPECT_THROW((void)read_particles("/no/such/file.csv"), InputError);
  EXPECT_THROW((void)read_particles(folder.at("zero.csv")), InputError);
  EXPECT_THROW((void)read_particles(folder.at("folder.csv")), InputError);
}

TEST(ParticleFiles, ComeBackBitForBit) {
  const std::vector<ParticleData> particles = some_particles();
  const std::string csv = temporary("back.csv");
  const std::string vtp = temporary("back.vtp");

  write_particles_csv(csv, particles);
  write_particles_vtp(vtp, particles);
  const ParticleFile from_csv = read_particles(csv);
  const ParticleFile from_vtp = read_particles(vtp);

  ASSERT_EQ(from_csv.particles.size(), particles.size());
  ASSERT_EQ(from_vtp.particles.size(), particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    expect_same(from_csv.particles[i], particles[i]);
    expect_same(from_vtp.particles[i], particles[i]);
  }
}

TEST(ParticleFiles, BringTemperaturesBackWhereThereAreAny) {
  std::vector<ParticleData> particles = some_particles();
  const std::string csv = temporary("warm.csv"), vtp = temporary("warm.vtp");
  write_particles_csv(csv, particles);
  EXPECT_EQ(read_text_file(csv).find("temperature"), std::string::npos);
  EXPECT_TRUE(std::isnan(read_particles(csv).particles[0].temperature));
  for (ParticleData& p : particles) p.temperature = 300.0 + 1.0 / static_cast<double>(p.id);

  write_particles_csv(csv, particles);
  write_particles_vtp(vtp, particles);

  for (const std::string& path : {csv, vtp}) {
    const ParticleFile file = read_particles(path);
    for (std::size_t p = 0; p < particles.size(); ++p)
      EXPECT_EQ(file.particles[p].temperature, particles[p].temperature) << path;
  }
}

TEST(ParticleFiles, ReadAMillionRowsInAFewSeconds) {
  std::vector<ParticleData> particles;
  for (int i = 0; i < 1000000; ++i) {
    const double t = i / 3.0;
    particles.push_back(
        {i + 1, 0, 0.05 + 1e-9 * t, 126.1234567890123, {t, t / 7, 0}, {t / 11, 0, 0}, {0, 0, t}});
  }
  const std::string path = temporary("million.csv");
  write_particles_csv(path, particles);

  const auto begin = std::chrono::steady_clock::now();
  const ParticleFile file = read_particles(path);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  EXPECT_EQ(file.particles.size(), particles.size());
  expect_same(file.particles.back(), particles.back());
  RecordProperty("seconds", std::to_string(seconds));
  EXPECT_LT(seconds, 20.0);  // 0.5 s on an idle core; sanitizers and busy machines take longer
}

constexpr const char* kData =
    "LAMMPS data file\n\n3 atoms\n2 atom types\n\n0 10 xlo xhi\n-1 8 ylo yhi\n-0.1 0.1 zlo zhi\n\n"
    "Atoms # sphere\n\n3 1 0.1 2000 1 2 0\n1 2 0.2 1000 3 4 0 0 0 0\n9 1 0.1 2000 5 6 0 # last\n\n"
    "Velocities\n\n9 1 2 3 4 5 6\n1 0.5 0 0 0 0 -1\n3 0 0 0 0 0 0\n";

TEST(ParticlesLammps, ReadsAtomsVelocitiesAndBox) {
  const ParticleFile file = parse_particles_lammps(kData, "a.data");

  ASSERT_EQ(file.particles.size(), 3u);
  expect_same(file.particles[0], {3, 0, 0.05, 2000, {1, 2, 0}, {0, 0, 0}, {0, 0, 0}});
  expect_same(file.particles[1], {1, 1, 0.1, 1000, {3, 4, 0}, {0.5, 0, 0}, {0, 0, -1}});
  expect_same(file.particles[2], {9, 0, 0.05, 2000, {5, 6, 0}, {1, 2, 3}, {4, 5, 6}});
  ASSERT_TRUE(file.box);
  EXPECT_EQ(file.box->lo, Vec3(0, -1, -0.1));
  EXPECT_EQ(file.box->hi, Vec3(10, 8, 0.1));
  EXPECT_TRUE(file.has_sphere_density);
  EXPECT_EQ(file.lines[2], 14);
}

TEST(ParticlesLammps, ConvertsSphereDensityToTheArealOneOfTheSameMass) {
  ParticleFile file = parse_particles_lammps(kData, "a.data");

  convert_to_areal_density(file);

  EXPECT_NEAR(file.particles[0].density, 2000 * 4.0 / 3.0 * 0.05, 1e-12);
  EXPECT_FALSE(file.has_sphere_density);
}

TEST(ParticlesLammps, GivesTheTitleNoMeaning) {
  std::string text = kData;
  text.replace(0, 6, "by LIGGGHTS");
  EXPECT_TRUE(parse_particles_lammps(text, "a.data").has_sphere_density);
}

TEST(ParticlesLammps, ComesBackFromItsOwnFile) {
  const std::vector<ParticleData> particles = some_particles();
  const std::string path = temporary("back.data");

  write_particles_lammps(path, particles, {}, {{Vec3(-2, -2, -2), Vec3(2, 2, 2)}, 3, true, false});
  const ParticleFile file = read_particles(path);

  ASSERT_EQ(file.particles.size(), particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) expect_same(file.particles[i], particles[i]);
  EXPECT_EQ(file.box->hi, Vec3(2, 2, 2));
}

TEST(ParticlesLammps, RefusesWhatItDoesNotUnderstand) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = kData;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  EXPECT_EQ(lammps_error(with("9 1 0.1 2000 5 6 0", "9 1 0.1 2000 5 6")).place().line, 14);
  EXPECT_EQ(lammps_error(with("9 1 0.1 2000 5 6 0", "3 1 0.1 2000 5 6 0")).place().line, 14);
  EXPECT_EQ(lammps_error(with("9 1 0.1 2000 5 6 0", "9 1 -0.1 2000 5 6 0")).place().line, 14);
  EXPECT_EQ(lammps_error(with("9 1 0.1 2000 5 6 0", "9 1 0.1 2000 nan 6 0")).place().column, 14);
  EXPECT_EQ(lammps_error(with("9 1 2 3 4 5 6", "8 1 2 3 4 5 6")).place().line, 18);
  EXPECT_EQ(lammps_error(with("Velocities", "Bodies")).place().line, 16);
  EXPECT_EQ(lammps_error(with("# sphere", "# atomic")).place().line, 10);
  EXPECT_EQ(lammps_error(with("0 10 xlo", "10 0 xlo")).place().line, 6);
  EXPECT_EQ(lammps_error(with("3 atoms", "x atoms")).place().line, 3);
  EXPECT_NE(std::string(lammps_error(with("3 atoms", "999999999999 atoms")).what()).find("3 rows"),
            std::string::npos);
  EXPECT_NE(std::string(lammps_error(with("0 10 xlo xhi", "")).what()).find("incomplete"),
            std::string::npos);
  EXPECT_NE(std::string(lammps_error("title\n").what()).find("no Atoms"), std::string::npos);
}

/// Every reader either reads a damaged text or refuses it by InputError: nothing else may happen.
void expect_no_crash(const std::string& seed, const std::function<void(std::string_view)>& read) {
  std::mt19937_64 random(12345);
  constexpr std::string_view kLikely = "0123456789,.-+e\n\r #<>/=\"nai";
  for (int round = 0; round < 4000; ++round) {
    std::string text = seed;
    const int num_edits = 1 + static_cast<int>(random() % 4);
    for (int edit = 0; edit < num_edits && !text.empty(); ++edit) {
      const std::size_t at = random() % text.size();
      const std::uint64_t kind = random() % 4;
      if (kind == 0) text.erase(at, random() % 20);
      if (kind == 1) text.insert(at, 1, kLikely[random() % kLikely.size()]);
      if (kind == 2) text[at] = static_cast<char>(random());
      if (kind == 3) text.resize(at);
    }
    try {
      read(text);
    } catch (const InputError&) {
    }
  }
}

TEST(ParticleFiles, SurviveDamagedTexts) {
  expect_no_crash(
      std::string(kHeader) + "1,1,0.1,1,0,0,0,1,2,3,4,5,6\n2,1,0.1,1,1,0,0,1,2,3,4,5,6\n",
      [](std::string_view text) { (void)parse_particles_csv(text, "f"); });
  expect_no_crash(kData, [](std::string_view text) { (void)parse_particles_lammps(text, "f"); });
}

TEST(OutputFile, LeavesNothingWithoutCommit) {
  const std::string path = temporary("absent");
  { OutputFile(path).write("half"); }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_THROW(OutputFile("/no/such/folder/file"), RunError);
}

}  // namespace
}  // namespace barchan
