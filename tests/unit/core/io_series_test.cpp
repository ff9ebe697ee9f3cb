#include <gtest/gtest.h>

#include <filesystem>

#include <unistd.h>

#include <barchan/core/error.hpp>
#include <barchan/core/io/series.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan {
namespace {

class Series : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  std::string path_ = (std::filesystem::temp_directory_path() /
                       ("barchan_series_" + std::to_string(::getpid()) + ".csv"))
                          .string();
  std::vector<std::string> columns_{"plate_y"};
};

TEST_F(Series, HasEachRowOnDiskAtOnce) {
  SeriesWriter series = SeriesWriter::create(path_, columns_);
  series.append({100, 0.02, 1.0 / 3.0, 12, 1e-5}, std::vector<double>{2.5});

  EXPECT_EQ(read_text_file(path_),
            "step,time,kinetic_energy,contacts,max_overlap,plate_y\n"
            "100,0.02,0.33333333333333331,12,1.0000000000000001e-05,2.5\n");
}

TEST_F(Series, DropsRowsAfterTheRestartAndUnfinishedOnes) {
  {
    SeriesWriter series = SeriesWriter::create(path_, columns_);
    for (const int step : {0, 100, 200, 300})
      series.append({step, 0, 0, 0, 0}, std::vector<double>{0});
  }
  {
    SeriesWriter series = SeriesWriter::resume(path_, columns_, 200);
    series.append({250, 0, 0, 0, 0}, std::vector<double>{1});
  }
  EXPECT_EQ(read_text_file(path_),
            "step,time,kinetic_energy,contacts,max_overlap,plate_y\n0,0,0,0,0,0\n100,0,0,0,0,"
            "0\n200,0,0,0,0,0\n"
            "250,0,0,0,0,1\n");
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 2);
  { SeriesWriter series = SeriesWriter::resume(path_, columns_, 1000); }
  EXPECT_TRUE(read_text_file(path_).ends_with("200,0,0,0,0,0\n"));
}

TEST_F(Series, RefusesToGoOnWithOtherColumns) {
  { SeriesWriter series = SeriesWriter::create(path_, columns_); }
  EXPECT_THROW(SeriesWriter::resume(path_, std::vector<std::string>{"else"}, 0), InputError);
}

TEST_F(Series, StartsAnewWithoutAFile) {
  { SeriesWriter series = SeriesWriter::resume(path_, columns_, 10); }
  EXPECT_EQ(read_text_file(path_), "step,time,kinetic_energy,contacts,max_overlap,plate_y\n");
  EXPECT_THROW(SeriesWriter::create("/no/such/folder/series.csv", columns_), RunError);
}

}  // namespace
}  // namespace barchan
