#include <gtest/gtest.h>

#include <filesystem>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/series.hpp>
#include <barchan/core/io/text_file.hpp>

#include <support/temporary_folder.hpp>

namespace barchan {
namespace {

using Cells = std::vector<std::optional<double>>;

class Series : public ::testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::string path_ = folder_.at("series.csv");
  std::vector<std::string> columns_{"plate_y"};
};

TEST_F(Series, HasEachRowOnDiskAtOnce) {
  SeriesWriter series = SeriesWriter::create(path_, columns_);
  series.append({100, 0.02, 1.0 / 3.0, 12, 1e-5}, Cells{2.5});

  EXPECT_EQ(read_text_file(path_),
            "step,time,kinetic_energy,contacts,max_overlap,plate_y\n"
            "100,0.02,0.33333333333333331,12,1.0000000000000001e-05,2.5\n");
}

TEST_F(Series, LeavesACellEmptyWhereThereIsNoValue) {
  columns_.emplace_back("plate_z");
  SeriesWriter series = SeriesWriter::create(path_, columns_);
  series.append({100, 0, 0, 0, 0}, Cells{std::nullopt, 1.0});

  EXPECT_TRUE(read_text_file(path_).ends_with("\n100,0,0,0,0,,1\n"));
}

TEST_F(Series, DropsRowsAfterTheRestartAndUnfinishedOnes) {
  {
    SeriesWriter series = SeriesWriter::create(path_, columns_);
    for (const int step : {0, 100, 200, 300}) series.append({step, 0, 0, 0, 0}, Cells{0.0});
  }
  {
    SeriesWriter series = SeriesWriter::resume(path_, columns_, 200);
    series.append({250, 0, 0, 0, 0}, Cells{1.0});
  }
  EXPECT_EQ(read_text_file(path_),
            "step,time,kinetic_energy,contacts,max_overlap,plate_y\n0,0,0,0,0,0\n100,0,0,0,0,"
            "0\n200,0,0,0,0,0\n"
            "250,0,0,0,0,1\n");
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 2);
  { SeriesWriter series = SeriesWriter::resume(path_, columns_, 1000); }
  EXPECT_TRUE(read_text_file(path_).ends_with("200,0,0,0,0,0\n"));
}

TEST_F(Series, KeepsRowsWithOtherColumnsInAFileOfTheirOwn) {
  for (const char* column : {"plate_y", "else", "more"}) {
    SeriesWriter series = SeriesWriter::resume(path_, std::vector<std::string>{column}, 100);
    EXPECT_NE(series.damage(200, 100), "") << column;
    for (const int step : {100, 200}) series.append({step, 0, 0, 0, 0}, Cells{0.0});
  }
  const std::string header = "step,time,kinetic_energy,contacts,max_overlap,";

  EXPECT_EQ(read_text_file(folder_.at("series_1.csv")), header + "plate_y\n100,0,0,0,0,0\n");
  EXPECT_EQ(read_text_file(folder_.at("series_2.csv")), header + "else\n100,0,0,0,0,0\n");
  EXPECT_EQ(read_text_file(path_), header + "more\n100,0,0,0,0,0\n200,0,0,0,0,0\n");
}

TEST_F(Series, StartsAnewWithoutAFile) {
  { SeriesWriter series = SeriesWriter::resume(path_, columns_, 10); }
  EXPECT_EQ(read_text_file(path_), "step,time,kinetic_energy,contacts,max_overlap,plate_y\n");
  EXPECT_THROW(SeriesWriter::create("/no/such/folder/series.csv", columns_), RunError);
}

std::string rows(std::initializer_list<int> steps) {
  std::string text = "step,time\n";
  for (const int step : steps) text += std::to_string(step) + ",0\n";
  return text;
}

TEST(DamageOfRows, IsNoneWhereARunWasLeftAlone) {
  EXPECT_EQ(damage_of_rows(rows({0, 100, 200, 300}), 350, 100), "");
  EXPECT_EQ(damage_of_rows(rows({0, 100, 200, 300}), 350, 10), "");  // rows come more often now
  EXPECT_EQ(damage_of_rows(rows({0, 10, 20, 100, 200}), 250, 100), "");
  EXPECT_EQ(damage_of_rows(rows({400, 500}), 600, 100), "");  // of a run that began at 400
}

TEST(DamageOfRows, IsTold) {
  EXPECT_EQ(damage_of_rows(rows({}), 350, 100), "there is no row before step 350");
  EXPECT_EQ(damage_of_rows(rows({0, 100}), 350, 100),
            "rows between step 100 and step 350 are missing");
  EXPECT_EQ(damage_of_rows(rows({0, 100, 400, 500}), 550, 100),
            "rows between step 100 and step 400 are missing");
  EXPECT_EQ(damage_of_rows(rows({0, 300, 400}), 450, 100),
            "rows between step 0 and step 300 are missing");
  EXPECT_EQ(damage_of_rows(rows({0, 200, 100}), 350, 100), "step 100 comes after step 200");
  EXPECT_EQ(damage_of_rows("step,time\n0,0,0\n", 350, 100),
            "the row of step 0 has other columns than the header");
}

}  // namespace
}  // namespace barchan
