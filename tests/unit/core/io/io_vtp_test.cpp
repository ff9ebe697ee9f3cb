#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <random>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/base64.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/core/io/vtp.hpp>
#include <barchan/core/io/xml.hpp>

#include <support/temporary_folder.hpp>

namespace barchan {
namespace {

std::string temporary(const std::string& name) {
  static const test::TemporaryFolder folder;
  return folder.at(name);
}

/// Three particles and the arrays that refer to them.
struct Snapshot {
  std::vector<double> points{0, 1, 2, 3, 4, 5, 6, 7, 1.0 / 3.0};
  std::vector<std::int64_t> ids{7, 8, std::int64_t{1} << 40};
  std::vector<std::int32_t> ranks{0, 1, -1};
  std::vector<double> radii{0.1, 0.2, 1e-300};

  [[nodiscard]] VtpArrays arrays() const {
    return {400,
            0.08,
            points,
            {{"id", 1, std::span<const std::int64_t>(ids)},
             {"rank", 1, std::span<const std::int32_t>(ranks)},
             {"a<b>&\"c\"", 1, std::span<const double>(radii)},
             {"velocity", 3, std::span<const double>(points)}}};
  }
};

/// Number of tags of that name; throws when the text is not properly nested.
int count_tags(const std::string& path, std::string_view name) {
  const std::string text = read_text_file(path);
  XmlReader xml(text, path);
  int count = 0;
  for (XmlToken token = xml.next(); token.kind != XmlToken::Kind::End; token = xml.next()) {
    count += token.name == name && token.kind != XmlToken::Kind::Close ? 1 : 0;
  }
  return count;
}

TEST(Base64, EncodesTheTestVectorsOfItsStandard) {
  const std::pair<std::string, std::string> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, encoded] : vectors) {
    for (std::size_t cut = 0; cut <= plain.size(); ++cut) {
      Base64Encoder encoder;
      std::string out;
      encoder.add(std::string_view(plain).substr(0, cut), out);
      encoder.add(std::string_view(plain).substr(cut), out);
      encoder.finish(out);
      EXPECT_EQ(out, encoded);
    }
    EXPECT_EQ(decode_base64("\n" + encoded + " \n"), plain);
  }
  EXPECT_FALSE(decode_base64("Zg=*"));
  EXPECT_FALSE(decode_base64("Z==="));
}

TEST(Vtp, ComesBackBitForBit) {
  const Snapshot snapshot;
  const std::string path = temporary("piece.vtp");

  write_vtp(path, snapshot.arrays());
  const VtpPiece piece = read_vtp(path);

  EXPECT_EQ(piece.step, 400);
  EXPECT_EQ(piece.time, 0.08);
  EXPECT_EQ(piece.points, snapshot.points);
  ASSERT_NE(piece.find("id"), nullptr);
  EXPECT_EQ(std::get<std::vector<std::int64_t>>(piece.find("id")->values), snapshot.ids);
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(piece.find("rank")->values), snapshot.ranks);
  EXPECT_EQ(std::get<std::vector<double>>(piece.find("a<b>&\"c\"")->values), snapshot.radii);
  EXPECT_EQ(piece.find("velocity")->components, 3);
  EXPECT_EQ(piece.find("nothing"), nullptr);
}

TEST(Vtp, IsWellFormedWithOneVertexPerPoint) {
  const std::string path = temporary("form.vtp");
  write_vtp(path, Snapshot().arrays());

  EXPECT_EQ(count_tags(path, "DataArray"), 2 + 4 + 1 + 2);
  EXPECT_NE(read_text_file(path).find("NumberOfPoints=\"3\" NumberOfVerts=\"3\""),
            std::string::npos);
}

/// The numbers of an array that read_vtp has no use for.
std::vector<std::int64_t> integers_of(const std::string& path, const std::string& name) {
  const std::string text = read_text_file(path);
  const std::size_t begin = text.find('>', text.find("Name=\"" + name + "\"")) + 1;
  const std::string bytes =
      decode_base64(std::string_view(text).substr(begin, text.find('<', begin) - begin)).value();
  std::vector<std::int64_t> numbers(bytes.size() / sizeof(std::int64_t));
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  EXPECT_EQ(numbers.at(0), static_cast<std::int64_t>(bytes.size() - sizeof numbers[0])) << name;
  numbers.erase(numbers.begin());
  return numbers;
}

TEST(Vtp, CellsEndWhereTheirOffsetsSay) {
  const std::string path = temporary("cells.vtp");
  const Snapshot snapshot;
  write_vtp(path, snapshot.arrays());

  EXPECT_EQ(integers_of(path, "connectivity"), (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(integers_of(path, "offsets"), (std::vector<std::int64_t>{1, 2, 3}));

  const std::vector<double> ends(12);  // of two lines
  write_vtp(path, {0, 0.0, ends, {}, true});
  EXPECT_EQ(integers_of(path, "connectivity"), (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(integers_of(path, "offsets"), (std::vector<std::int64_t>{2, 4}));
}

TEST(Vtp, MayBeEmpty) {
  const std::string path = temporary("empty.vtp");
  write_vtp(path, VtpArrays{});
  EXPECT_TRUE(read_vtp(path).points.empty());
}

TEST(Vtp, RefusesFieldsOfAnotherLength) {
  const Snapshot snapshot;
  VtpArrays arrays = snapshot.arrays();
  arrays.fields[0].components = 2;
  EXPECT_THROW(write_vtp(temporary("bad.vtp"), arrays), std::logic_error);
}

TEST(Vtp, NamesPiecesAndTimes) {
  const std::string pvtp = temporary("all.pvtp");
  const std::string pvd = temporary("all.pvd");
  const Snapshot snapshot;

  write_pvtp(pvtp, std::vector<std::string>{"s_0.vtp", "s_1.vtp"}, snapshot.arrays());
  write_pvd(pvd, std::vector<PvdEntry>{{0.0, "a.pvtp"}, {0.1, "b&c.pvtp"}});

  const std::filesystem::path folder = std::filesystem::path(pvtp).parent_path();
  EXPECT_EQ(read_pvtp(pvtp), (std::vector<std::string>{(folder / "s_0.vtp").string(),
                                                       (folder / "s_1.vtp").string()}));
  EXPECT_EQ(count_tags(pvtp, "PDataArray"), 5);
  const std::vector<PvdEntry> entries = read_pvd(pvd);
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[1].time, 0.1);
  EXPECT_EQ(entries[1].file, "b&c.pvtp");
}

TEST(Vtp, SurvivesDamagedTexts) {
  const std::string path = temporary("damage.vtp");
  write_vtp(path, Snapshot().arrays());
  const std::string whole = read_text_file(path);
  std::mt19937_64 random(7);
  int num_refused = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = whole;
    const std::size_t at = random() % text.size();
    if (round % 3 == 0) text.resize(at);
    if (round % 3 == 1) text.erase(at, random() % 30);
    if (round % 3 == 2) text[at] = static_cast<char>(random());
    try {
      (void)parse_vtp(text, "damaged");
    } catch (const InputError&) {
      ++num_refused;
    }
  }
  EXPECT_GT(num_refused, 1500);
}

}  // namespace
}  // namespace barchan
