#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <png.h>
#include <zlib.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/canvas.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan {
namespace {

/// 8-bit sRGB of linear light, by a table: a power per pixel would cost more than the drawing.
std::uint8_t srgb_from_linear(float value) {
  constexpr std::size_t kSize = 4096;
  static const auto kTable = [] {
    std::array<std::uint8_t, kSize> table{};
    for (std::size_t i = 0; i < kSize; ++i) {
      const double x = static_cast<double>(i) / (kSize - 1);
      const double y = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
      table[i] = static_cast<std::uint8_t>(255.0 * y + 0.5);
    }
    return table;
  }();
  const float clamped = value > 0.0F ? (value < 1.0F ? value : 1.0F) : 0.0F;
  return kTable[static_cast<std::size_t>(clamped * (kSize - 1) + 0.5F)];
}

constexpr std::size_t kHeaderSize = 8 + 12 + 13;  // signature and the chunk IHDR

/// Big-endian, as PNG has numbers.
std::string four_bytes(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xff);
  return bytes;
}

/// The standard keyword for the program that wrote a picture:
/// | length | tEXt Software 0 name | CRC |
std::string software_chunk() {
  constexpr std::string_view text("tEXtSoftware\0barchan", 20);
  const auto* bytes = reinterpret_cast<const Bytef*>(text.data());
  const auto sum = static_cast<std::uint32_t>(::crc32(0, bytes, static_cast<uInt>(text.size())));
  return four_bytes(static_cast<std::uint32_t>(text.size() - 4)) + std::string(text) +
         four_bytes(sum);
}

}  // namespace

void Canvas::write_png(const std::string& path) const {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * pixels_.size());
  for (const Pixel& pixel : pixels_) {
    for (const float value : {pixel.light.r, pixel.light.g, pixel.light.b})
      bytes.push_back(srgb_from_linear(value));
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_);
  image.height = static_cast<png_uint_32>(height_);
  image.format = PNG_FORMAT_RGB;
  std::string encoded(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = encoded.size();
  const int done =
      png_image_write_to_memory(&image, encoded.data(), &size, 0, bytes.data(), 0, nullptr);
  if (done == 0) throw RunError("cannot encode " + path + ": " + image.message);
  OutputFile file(path);
  const std::string_view png = std::string_view(encoded).substr(0, size);
  file.write(png.substr(0, kHeaderSize));
  file.write(software_chunk());
  file.write(png.substr(kHeaderSize));
  file.commit();
}

}  // namespace barchan
