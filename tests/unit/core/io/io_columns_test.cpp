// Names, separators, quotes and encodings of tables as other programs write them.
#include <gtest/gtest.h>

#include <algorithm>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/gzip.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/text_file.hpp>

#include <support/temporary_folder.hpp>

namespace barchan {
namespace {

/// The one particle of a table, whatever the names of its columns.
ParticleData particle_of(const std::string& text) {
  const ParticleFile file = parse_particles_csv(text, "t.csv");
  EXPECT_EQ(file.particles.size(), 1u) << text;
  return file.particles.at(0);
}

std::string error_of(const std::string& text) {
  try {
    (void)parse_particles_csv(text, "t.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error for: " + text;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

constexpr const char* kHead = "id,type,radius,density,x,y,z";

TEST(ColumnNames, AreReadInTheFormsOfOtherPrograms) {
  const std::pair<const char*, const char*> headers[] = {
      {"Vx,Vy,Vz", "OmegaX,OmegaY,OmegaZ"},
      {"v_x,v_y,v_z", "omega_x,omega_y,omega_z"},
      {"VX,VY,VZ", "WX,WY,WZ"},
      {"velocity:0,velocity:1,velocity:2",
       "angular_velocity:0,angular_velocity:1,angular_velocity:2"},
      {"velocity_0,velocity_1,velocity_2",
       "angular_velocity_0,angular_velocity_1,angular_velocity_2"},
      {"velocity[0],velocity[1],velocity[2]", "omega[0],omega[1],omega[2]"},
      {"Velocity.X,Velocity.Y,Velocity.Z",
       "Angular Velocity.X,Angular Velocity.Y,Angular Velocity.Z"},
      {"vel_x,vel_y,vel_z", "ang_vel_x,ang_vel_y,ang_vel_z"},
      {"velocity_x,velocity_y,velocity_z", "w_x,w_y,w_z"}};
  for (const auto& [velocity, omega] : headers) {
    const ParticleData p = particle_of(std::string(kHead) + "," + velocity + "," + omega +
                                       "\n1,1,0.1,2,7,8,9,1,2,3,4,5,6\n");
    EXPECT_EQ(p.velocity, Vec3(1, 2, 3)) << velocity;
    EXPECT_EQ(p.omega, Vec3(4, 5, 6)) << omega;
    EXPECT_EQ(p.position, Vec3(7, 8, 9)) << velocity;
  }
}

TEST(ColumnNames, OfPositionsAndIdsAreReadToo) {
  for (const char* position : {"Points:0,Points:1,Points:2", "Points_0,Points_1,Points_2",
                               "Position.X,Position.Y,Position.Z", "X,Y,Z", "xu,yu,zu"}) {
    const ParticleData p =
        particle_of(std::string("Particle Identifier,Particle Type,Radius,DENSITY,") + position +
                    "\n3,2,0.1,2,7,8,9\n");
    EXPECT_EQ(p.position, Vec3(7, 8, 9)) << position;
    EXPECT_EQ(p.id, 3);
    EXPECT_EQ(p.type, 1);
  }
}

TEST(ColumnNames, OfDiametersCountWhereThereIsNoRadius) {
  EXPECT_EQ(particle_of("id,type,Diameter,density,x,y\n1,1,0.5,1,0,0\n").radius, 0.25);

  const ParticleFile file =
      parse_particles_csv("id,type,diameter,radius,density,x,y\n1,1,9,0.25,1,0,0\n", "t.csv");
  EXPECT_EQ(file.particles[0].radius, 0.25);
  EXPECT_EQ(file.notes, std::vector<std::string>{"columns not used: 'diameter'"});
}

TEST(ColumnNames, ThatAreNotUsedAreListedOnce) {
  const ParticleFile file = parse_particles_csv(
      std::string(",Unnamed: 0,rank,mass,fx,velocity_Magnitude,c_1[2],") + kHead +
          "\n0,0,0,1,2,3,4,1,1,0.1,2,7,8,9\n1,1,0,1,2,3,4,2,1,0.1,2,7,8,9\n",
      "t.csv");

  EXPECT_EQ(file.notes, std::vector<std::string>{
                            "columns not used: (unnamed), 'Unnamed: 0', 'rank', 'mass', 'fx', "
                            "'velocity_Magnitude', 'c_1[2]'"});
}

TEST(ColumnNames, NearKnownOnesAreErrors) {
  const std::pair<const char*, const char*> cases[] = {
      {"velocty_x", "did you mean 'vx'"},
      {"Vxx", "did you mean 'vx'"},
      {"omga_z", "did you mean 'omegaz'"},
      {"velocity", "did you mean 'vx'"},
      {"velocity:3", "did you mean 'v"},
      {"x_velocity", "did you mean 'vx'"},
      {"angular_velocity_w", "did you mean 'omega"}};
  for (const auto& [name, remedy] : cases) {
    const std::string error = error_of(std::string(kHead) + "," + name + "\n1,1,0.1,2,7,8,9,1\n");
    EXPECT_TRUE(has(error, "t.csv:1: column '" + std::string(name) + "' is not known")) << error;
    EXPECT_TRUE(has(error, remedy)) << error;
  }
  EXPECT_TRUE(has(error_of("id,type,radus,density,x,y\n"), "did you mean 'radius'"));
}

TEST(ColumnNames, OfParaViewsCountersAreNoCoordinates) {
  const ParticleFile file =
      parse_particles_csv("Point ID,id,type,radius,density,x,y\n0,1,1,0.1,1,0,0\n", "t.csv");
  EXPECT_EQ(file.notes, std::vector<std::string>{"columns not used: 'Point ID'"});
}

TEST(ColumnNames, WithUnitsAreErrors) {
  for (const char* name : {"vx [mm/s]", "Vx (m/s)", "vx_m_s", "velocity:0 [m/s]", "vx_mm_s"}) {
    const std::string error = error_of(std::string(kHead) + "," + name + "\n1,1,0.1,2,7,8,9,1\n");
    EXPECT_TRUE(has(error, "column '" + std::string(name) + "' names a unit")) << error;
    EXPECT_TRUE(has(error, "call it 'vx'")) << error;
  }
  EXPECT_TRUE(has(error_of("id,type,radius [mm],density,x,y\n1,1,1,1,1,1\n"), "'radius [mm]'"));
}

TEST(ColumnNames, ThatCountFromOneAreErrors) {
  const std::string error = error_of(std::string(kHead) + ",v1,v2,v3\n1,1,0.1,2,7,8,9,1,2,3\n");
  EXPECT_TRUE(has(error, "components count from 0")) << error;
}

TEST(ColumnNames, ThatGiveTheSameTwiceAreErrors) {
  const std::string error = error_of(std::string(kHead) + ",Points:0\n1,1,0.1,2,7,8,9,1\n");
  EXPECT_TRUE(has(error, "columns 'x' and 'Points:0' both give 'x'")) << error;
}

TEST(Tables, MayBeSeparatedBySemicolonsOrTabs) {
  for (const char separator : {';', '\t', '|'}) {
    std::string text = "id,type,radius,density,x,y,vx\n1,1,0.1,2,7,8,9\n";
    std::replace(text.begin(), text.end(), ',', separator);
    if (separator == '|') text = "sep=|\r\n" + text;
    EXPECT_EQ(particle_of(text).velocity, Vec3(9, 0, 0)) << separator;
  }
  EXPECT_EQ(particle_of("\"sep=;\"\nid;type;radius;density;x;y\n1;1;0.1;2;7;8\n").radius, 0.1);
}

TEST(Tables, KeepEmptyFieldsBetweenTabs) {
  const std::string head = "id\ttype\tradius\tdensity\tx\ty\tlabel\tvx\n";
  EXPECT_EQ(particle_of(head + "1\t1\t0.1\t2\t7\t8\t\t3\n").velocity, Vec3(3, 0, 0));
}

TEST(Tables, MayQuoteNamesAndValues) {
  const ParticleData p = particle_of(
      "\"id\",\"type\",\"radius\",\"density\",\"x\",\"y\",\"a \"\"label\"\", or so\"\n"
      "\"1\", \"1\" ,\"0.1\",\"2\",\"7\",\"8\",\"one, two\"\n");
  EXPECT_EQ(p.position, Vec3(7, 8, 0));
  EXPECT_TRUE(has(error_of("id,type,radius,density,x,y\n1,1,\"0.1,2,7,8\n"), "t.csv:2:5: a quote"));
  EXPECT_TRUE(has(error_of("id,type,radius,density,x,y\n1,1,\"0.1\"5,2,7,8\n"), "closing quote"));
}

TEST(Tables, MayWriteWholeNumbersWithAPoint) {
  EXPECT_EQ(particle_of("id,type,radius,density,x,y\n12.0,2.0,0.1,2,7,8\n").id, 12);
  EXPECT_EQ(particle_of("id,type,radius,density,x,y\n1e3,1,0.1,2,7,8\n").id, 1000);
  EXPECT_EQ(particle_of("id,type,radius,density,x,y\n4611686018427387903,1,0.1,2,7,8\n").id,
            4611686018427387903);
  EXPECT_TRUE(has(error_of("id,type,radius,density,x,y\n1.5,1,1,1,1,1\n"), "not a whole number"));
}

TEST(Tables, SayThatADecimalCommaIsOne) {
  const std::string head = "id;type;radius;density;x;y\n";
  const std::string error = error_of(head + "1;1;0,1;2;7;8\n");
  EXPECT_TRUE(has(error, "t.csv:2:5: radius is '0,1', which has a decimal comma")) << error;
  EXPECT_TRUE(has(error, "write a decimal point: 0.1")) << error;
  EXPECT_TRUE(has(error_of("id,type,radius,density,x,y\n1,1,0,1,2,7,8\n"), "decimal point"));
}

TEST(Tables, TakeACommaBeforeThreeDigitsForNoDecimalComma) {
  const std::string error = error_of("id,type,radius,density,x,y\n1,1,0.1,\"2,650\",7,8\n");
  EXPECT_TRUE(has(error, "t.csv:2:10: density is '2,650', which has a comma (write")) << error;
  EXPECT_TRUE(has(error, "no mark between thousands")) << error;
}

TEST(Tables, SaySoWhereBlanksSeparateColumns) {
  EXPECT_TRUE(has(error_of("id type radius density x y\n1 1 1 1 1 1\n"), "separated by blanks"));
  EXPECT_TRUE(has(error_of("id|type|radius|density|x|y\n1|1|1|1|1|1\n"), "separated by bars"));
}

std::string utf16(const std::string& text, bool is_little) {
  std::string bytes = is_little ? "\xFF\xFE" : "\xFE\xFF";
  for (const char c : text) {
    if (!is_little) bytes.push_back('\0');
    bytes.push_back(c);
    if (is_little) bytes.push_back('\0');
  }
  return bytes;
}

TEST(Tables, MayBeUtf16AndOfAnOldMac) {
  const std::string text = "id,type,radius,density,x,y\r\n1,1,0.1,2,7,8\r\n";
  EXPECT_EQ(particle_of(utf16(text, true)).radius, 0.1);
  EXPECT_EQ(particle_of(utf16(text, false)).radius, 0.1);
  EXPECT_EQ(particle_of("id,type,radius,density,x,y\r1,1,0.1,2,7,8\r").radius, 0.1);
  EXPECT_TRUE(has(error_of(utf16(text, true).substr(2)), "UTF-16 without a mark"));
  EXPECT_TRUE(has(error_of(utf16(text, true) + "x"), "ends within"));
  EXPECT_TRUE(has(error_of("\xFF\xFE\x01\xD8\x01\x01"), "half of a UTF-16 character"));
}

/// "id,type,radius,density,x,y\n1,1,0.1,2,7,8\n" by gzip.
std::string packed_table() {
  constexpr unsigned char kBytes[] = {
      0x1f, 0x8b, 0x08, 0x00, 0x00, 0x00, 0x00, 0x00, 0x02, 0x03, 0xcb, 0x4c, 0xd1,
      0x29, 0xa9, 0x2c, 0x48, 0xd5, 0x29, 0x4a, 0x4c, 0xc9, 0x2c, 0x2d, 0xd6, 0x49,
      0x49, 0xcd, 0x2b, 0xce, 0x2c, 0xa9, 0xd4, 0xa9, 0xd0, 0xa9, 0xe4, 0x32, 0xd4,
      0x31, 0xd4, 0x31, 0xd0, 0x33, 0xd4, 0x31, 0xd2, 0x31, 0xd7, 0xb1, 0xe0, 0x02,
      0x00, 0x56, 0xd3, 0xaa, 0x59, 0x29, 0x00, 0x00, 0x00};
  return {reinterpret_cast<const char*>(kBytes), sizeof(kBytes)};
}

TEST(PackedFiles, AreUnpackedMemberAfterMember) {
  const std::string text = "id,type,radius,density,x,y\n1,1,0.1,2,7,8\n";
  EXPECT_EQ(unzipped(packed_table(), "t.gz"), text);
  EXPECT_EQ(unzipped(packed_table() + packed_table() + std::string(3, '\0'), "t.gz"), text + text);
}

TEST(PackedFiles, ThatAreDamagedAreErrors) {
  const std::string packed = packed_table();
  for (std::size_t size = 2; size < packed.size(); ++size)
    EXPECT_THROW((void)unzipped(packed.substr(0, size), "t.gz"), InputError) << size;
  EXPECT_THROW((void)unzipped(packed + "more", "t.gz"), InputError);
}

TEST(PackedFiles, AreReadUnderTheirEnding) {
  const test::TemporaryFolder folder;
  const std::string path = folder.at("grains.CSV.gz");
  OutputFile file(path);
  file.write(packed_table());
  file.commit();

  EXPECT_EQ(read_particles(path).particles.at(0).radius, 0.1);
}

TEST(ParticleFormats, AreToldByEndings) {
  EXPECT_EQ(particle_format("a.csv"), ParticleFormat::Csv);
  EXPECT_EQ(particle_format("a.TSV"), ParticleFormat::Csv);
  EXPECT_EQ(particle_format("a.lmp.gz"), ParticleFormat::LammpsData);
  EXPECT_EQ(particle_format("b.c/a.pvtp"), ParticleFormat::Pvtp);
  EXPECT_FALSE(particle_format("a.dump"));
  EXPECT_FALSE(particle_format("csv"));
  try {
    (void)read_particles("grains.xyz");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_TRUE(has(error.what(), "grains.xyz") && has(error.what(), ".pvtp")) << error.what();
  }
}

}  // namespace
}  // namespace barchan
