#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace barchan {

/// Linear light, 0 to 1 each.
struct Colour {
  float r = 0.0F;
  float g = 0.0F;
  float b = 0.0F;

  /// From sRGB 0xRRGGBB.
  [[nodiscard]] static Colour from_hex(std::uint32_t rgb);
  [[nodiscard]] Colour scaled(float factor) const { return {r * factor, g * factor, b * factor}; }
};

[[nodiscard]] Colour mix(const Colour& a, const Colour& b, float share_of_b);

struct PixelPoint {
  double x = 0.0;
  double y = 0.0;
};

struct Stroke {
  double thickness = 1.0;  ///< [pixels]
  Colour colour;
  bool is_behind = false;  ///< seen only where nothing was added
};

/// Perceptual colour map: even steps of lightness from deep blue over red to pale sand (OKLab).
/// @param t  0 to 1, clamped
[[nodiscard]] Colour colour_map(double t);

/// A colour for each of a few kinds, repeating after eight.
[[nodiscard]] Colour kind_colour(int kind);

/// An image under construction, white at first. Pixel (0, 0) is at the top left; its centre is at
/// (0.5, 0.5). What is drawn by add() gathers as light and coverage and lies behind nothing yet
/// drawn: nearer things first.
class Canvas {
 public:
  Canvas(int width, int height);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// Adds a colour behind what is there; `coverage` 0 to 1.
  void add_behind(int x, int y, const Colour& colour, float coverage);
  /// Adds a colour beside what is there: shares of a pixel that do not overlap.
  void add_beside(int x, int y, const Colour& colour, float coverage);
  [[nodiscard]] float coverage(int x, int y) const;

  /// Fills the rest with white; from here on only over() draws. `gain` above 1 closes the gaps
  /// between things that are smaller than a pixel, whose colours would pale otherwise.
  void put_on_white(float gain);
  void over(int x, int y, const Colour& colour, float coverage);
  void line(const PixelPoint& from, const PixelPoint& to, const Stroke& stroke);
  void rectangle(int x0, int y0, int x1, int y1, const Colour& colour);
  /// Text with its top left at (x, y); a character is 6·scale wide.
  void text(int x, int y, std::string_view text, int scale, const Colour& colour);

  /// Writes an 8-bit sRGB PNG that appears under its name when complete. @throws RunError
  void write_png(const std::string& path) const;

 private:
  struct Pixel {
    Colour light;
    float coverage = 0.0F;
  };

  [[nodiscard]] Pixel* at(int x, int y);

  int width_;
  int height_;
  std::vector<Pixel> pixels_;
};

[[nodiscard]] int text_width(std::string_view text, int scale);

}  // namespace barchan
