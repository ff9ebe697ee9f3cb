#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <barchan/core/io/canvas.hpp>
#include <barchan/core/io/font.hpp>

namespace barchan {
namespace {

float linear_from_srgb(float value) {
  return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}

/// OKLab to linear sRGB (Ottosson 2020).
Colour from_oklab(double lightness, double a, double b) {
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  const auto clip = [](double x) { return static_cast<float>(std::clamp(x, 0.0, 1.0)); };
  return {clip(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          clip(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          clip(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

Colour map_entry(double t) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  const double lightness = 0.30 + 0.60 * t;
  const double hue = (265.0 + 185.0 * t) * kDegree;
  const double chroma =
      0.10 + 0.09 * std::sin(std::numbers::pi * std::min(1.0, 1.15 * t)) - 0.01 * t;
  return from_oklab(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
}

}  // namespace

Colour Colour::from_hex(std::uint32_t rgb) {
  const auto part = [rgb](int shift) {
    return linear_from_srgb(static_cast<float>(rgb >> shift & 0xff) / 255.0F);
  };
  return {part(16), part(8), part(0)};
}

Colour mix(const Colour& a, const Colour& b, float share_of_b) {
  const float rest = 1.0F - share_of_b;
  return {rest * a.r + share_of_b * b.r, rest * a.g + share_of_b * b.g,
          rest * a.b + share_of_b * b.b};
}

Colour colour_map(double t) {
  static const auto kTable = [] {
    std::array<Colour, 256> table;
    for (std::size_t i = 0; i < table.size(); ++i)
      table[i] = map_entry(static_cast<double>(i) / 255.0);
    return table;
  }();
  if (!(t > 0.0)) return kTable.front();
  return kTable[static_cast<std::size_t>(std::min(t, 1.0) * 255.0 + 0.5)];
}

Colour kind_colour(int kind) {
  static const std::array<Colour, 8> kColours = {
      Colour::from_hex(0xdcb878), Colour::from_hex(0x2f6690), Colour::from_hex(0xb5523b),
      Colour::from_hex(0x5a8f5a), Colour::from_hex(0x7d5ba6), Colour::from_hex(0x8a8d91),
      Colour::from_hex(0x3aa6a0), Colour::from_hex(0xd9895b)};
  return kColours[static_cast<std::size_t>(kind < 0 ? -kind : kind) % kColours.size()];
}

Canvas::Canvas(int width, int height)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

Canvas::Pixel* Canvas::at(int x, int y) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return nullptr;
  return &pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)];
}

float Canvas::coverage(int x, int y) const {
  return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(x)]
      .coverage;
}

void Canvas::add_behind(int x, int y, const Colour& colour, float coverage) {
  if (Pixel* pixel = at(x, y)) add_beside(x, y, colour, coverage * (1.0F - pixel->coverage));
}

void Canvas::add_beside(int x, int y, const Colour& colour, float coverage) {
  Pixel* pixel = at(x, y);
  if (pixel == nullptr) return;
  pixel->light.r += colour.r * coverage;
  pixel->light.g += colour.g * coverage;
  pixel->light.b += colour.b * coverage;
  pixel->coverage += coverage;
}

void Canvas::put_on_white(float gain) {
  for (Pixel& pixel : pixels_) {
    const float covered = std::min(1.0F, gain * pixel.coverage);
    const float white = 1.0F - covered;
    const float scale = pixel.coverage > 0.0F ? covered / pixel.coverage : 0.0F;
    pixel.light = {pixel.light.r * scale + white, pixel.light.g * scale + white,
                   pixel.light.b * scale + white};
    pixel.coverage = covered;
  }
}

void Canvas::over(int x, int y, const Colour& colour, float coverage) {
  if (Pixel* pixel = at(x, y))
    pixel->light = mix(pixel->light, colour, std::clamp(coverage, 0.0F, 1.0F));
}

void Canvas::line(const PixelPoint& from, const PixelPoint& to, const Stroke& stroke) {
  const double dx = to.x - from.x, dy = to.y - from.y;
  const double length2 = dx * dx + dy * dy;
  const double reach = 0.5 * stroke.thickness + 1.0;
  const auto first = [reach](double a, double b) {
    return static_cast<int>(std::clamp(std::floor(std::min(a, b) - reach), 0.0, 1e6));
  };
  const auto last = [reach](double a, double b, int end) {
    return static_cast<int>(std::clamp(std::ceil(std::max(a, b) + reach), 0.0, 1.0 * end));
  };
  for (int y = first(from.y, to.y); y < last(from.y, to.y, height_); ++y) {
    for (int x = first(from.x, to.x); x < last(from.x, to.x, width_); ++x) {
      const double px = x + 0.5 - from.x, py = y + 0.5 - from.y;
      const double t = length2 > 0.0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
      const double distance = std::hypot(px - t * dx, py - t * dy);
      const double share = std::clamp(0.5 * stroke.thickness + 0.5 - distance, 0.0, 1.0);
      const float seen = stroke.is_behind ? 1.0F - coverage(x, y) : 1.0F;
      over(x, y, stroke.colour, static_cast<float>(share) * seen);
    }
  }
}

void Canvas::rectangle(int x0, int y0, int x1, int y1, const Colour& colour) {
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) over(x, y, colour, 1.0F);
  }
}

void Canvas::text(int x, int y, std::string_view text, int scale, const Colour& colour) {
  for (const char character : text) {
    const auto& rows = glyph(character);
    for (int row = 0; row < kGlyphHeight; ++row) {
      for (int column = 0; column < kGlyphWidth; ++column) {
        if ((rows[static_cast<std::size_t>(row)] >> (kGlyphWidth - 1 - column) & 1) == 0) continue;
        const int left = x + column * scale, top = y + row * scale;
        rectangle(left, top, left + scale, top + scale, colour);
      }
    }
    x += (kGlyphWidth + 1) * scale;
  }
}

int text_width(std::string_view text, int scale) {
  return static_cast<int>(text.size()) * (kGlyphWidth + 1) * scale - (text.empty() ? 0 : scale);
}

}  // namespace barchan
