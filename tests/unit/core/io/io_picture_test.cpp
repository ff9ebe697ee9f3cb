#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <png.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/canvas.hpp>
#include <barchan/core/io/picture.hpp>

#include <support/temporary_folder.hpp>

namespace barchan {
namespace {

/// A PNG read back.
struct Image {
  unsigned width = 0;
  unsigned height = 0;
  std::vector<std::uint8_t> rgb;

  /// 0xRRGGBB
  [[nodiscard]] unsigned at(unsigned x, unsigned y) const {
    const std::size_t i = 3 * (std::size_t{y} * width + x);
    return static_cast<unsigned>(rgb[i]) << 16 | static_cast<unsigned>(rgb[i + 1]) << 8 |
           rgb[i + 2];
  }
  [[nodiscard]] std::size_t count(unsigned colour) const {
    std::size_t n = 0;
    for (unsigned y = 0; y < height; ++y) {
      for (unsigned x = 0; x < width; ++x) n += at(x, y) == colour ? 1 : 0;
    }
    return n;
  }
};

Image read_png(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0);
  image.format = PNG_FORMAT_RGB;
  Image result{image.width, image.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
  EXPECT_NE(png_image_finish_read(&image, nullptr, result.rgb.data(), 0, nullptr), 0);
  return result;
}

class Picture : public ::testing::Test {
 protected:
  Image draw(PictureInput input) {
    input.positions = positions_;
    input.radii = radii_;
    write_picture(path_, input);
    return read_png(path_);
  }

  std::vector<Vec3> positions_;
  std::vector<double> radii_;
  test::TemporaryFolder folder_;
  std::string path_ = folder_.at("picture.png");
};

TEST_F(Picture, DrawsADiskOfTheRightArea) {
  positions_ = {{5, 5, 0}};
  radii_ = {2};
  PictureInput input;
  input.hi = Vec3(10, 10, 0);
  input.lines = {{Vec3(0, 0, 0), Vec3(10, 0, 0)}, {Vec3(0, 10, 0), Vec3(10, 10, 0)}};
  input.width = 600;

  const Image image = draw(input);

  const double pixels_per_metre = (600 - 56) / 10.0;
  const double inner = 2 * pixels_per_metre - 2.5;
  EXPECT_EQ(image.width, 600u);
  EXPECT_EQ(image.at(300, 28 + 272), 0xdcb878u);
  EXPECT_NEAR(static_cast<double>(image.count(0xdcb878)), std::acos(-1.0) * inner * inner,
              0.03 * inner * inner);
}

TEST_F(Picture, CopesWithNothingAndWithWhatIsNotFinite) {
  PictureInput input;
  input.hi = Vec3(1, 1, 0);
  EXPECT_GT(draw(input).height, 10u);

  const double nan = std::numeric_limits<double>::quiet_NaN();
  positions_ = {{0.5, 0.5, 0},
                {nan, 0, 0},
                {1e300, 0, 0},
                {0.1, -std::numeric_limits<double>::infinity(), 0}};
  radii_ = {0.1, 0.1, 0.1, 1e9};
  const std::vector<double> values = {nan, 1, 2, 3};
  input.values = values;
  for (const int dimension : {2, 3}) {
    input.dimension = dimension;
    input.hi.z() = 1.0;
    EXPECT_GT(draw(input).height, 10u);
  }
}

TEST_F(Picture, ShowsTheNearerSphereInFront) {
  positions_ = {{5, 8, 5}, {5, 2, 5}};
  radii_ = {1, 1};
  const std::vector<double> kinds = {1, 0};
  PictureInput input;
  input.dimension = 3;
  input.hi = Vec3(10, 10, 10);
  input.values = kinds;
  input.values_are_kinds = true;
  input.kinds = {"near", "far"};

  const Image image = draw(input);

  const unsigned middle = image.at(image.width / 2, (image.height - 16 - 22) / 2);
  EXPECT_GT(middle >> 16 & 0xff, middle & 0xff) << "sand-coloured, not blue";
}

TEST_F(Picture, RefusesArraysOfDifferentLength) {
  positions_ = {{5, 8, 5}};
  EXPECT_THROW(draw(PictureInput{}), std::logic_error);
}

TEST_F(Picture, SaysWhenItCannotBeWritten) {
  PictureInput input;
  input.hi = Vec3(1, 1, 0);
  EXPECT_THROW(write_picture("/no/such/folder/picture.png", input), RunError);
}

TEST(ColourMap, GetsLighterAllTheWay) {
  const auto luminance = [](const Colour& c) {
    return 0.2126F * c.r + 0.7152F * c.g + 0.0722F * c.b;
  };
  for (int i = 0; i < 20; ++i) {
    EXPECT_LT(luminance(colour_map(i / 20.0)), luminance(colour_map((i + 1) / 20.0)));
  }
}

}  // namespace
}  // namespace barchan
