#include <algorithm>
#include <cmath>
#include <numbers>

#include <barchan/core/io/circles.hpp>

namespace barchan {
namespace {

constexpr float kCovered = 0.99F;
constexpr int kSide = 8;

/// Coverage of a pixel whose centre is at `distance` from the centre of a circle [pixels].
float circle_coverage(double radius, double distance) {
  return static_cast<float>(std::clamp(radius + 0.5 - distance, 0.0, 1.0));
}

/// Calls use(x, y, dx, dy) for the pixels of the square around a circle.
template <class Use>
void for_each_pixel(const Canvas& canvas, const Circle& circle, Use use) {
  const double reach = circle.radius + 0.5;
  const double limit = 1e6;
  if (!(std::abs(circle.x) < limit && std::abs(circle.y) < limit && reach < limit)) return;
  const int first_x = std::max(0, static_cast<int>(std::floor(circle.x - reach)));
  const int last_x = std::min(canvas.width() - 1, static_cast<int>(std::floor(circle.x + reach)));
  const int first_y = std::max(0, static_cast<int>(std::floor(circle.y - reach)));
  const int last_y = std::min(canvas.height() - 1, static_cast<int>(std::floor(circle.y + reach)));
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      const double dx = x + 0.5 - circle.x, dy = y + 0.5 - circle.y;
      use(x, y, dx, dy);
    }
  }
}

/// Circles of less than a pixel spread their area over the four pixels they lie among.
void splat(Canvas& canvas, const Circle& circle, const Colour& colour) {
  const double area = std::numbers::pi * circle.radius * circle.radius;
  const double side = std::max(1.0, 2.0 * circle.radius);
  const auto share = [side](double center, int pixel) {
    return std::max(0.0, std::min(center + 0.5 * side, pixel + 1.0) -
                             std::max(center - 0.5 * side, 1.0 * pixel)) /
           side;
  };
  for_each_pixel(canvas, {circle.x, circle.y, 0.5 * side}, [&](int x, int y, double, double) {
    canvas.add_beside(x, y, colour,
                      static_cast<float>(area * share(circle.x, x) * share(circle.y, y)));
  });
}

}  // namespace

void draw_disk(Canvas& canvas, const Circle& circle, const Colour& colour) {
  if (circle.radius < 1.0) return splat(canvas, circle, colour);
  const double rim = circle.radius > 4.0 ? std::min(2.0, 0.12 * circle.radius) : 0.0;
  const Colour edge = colour.scaled(0.45F);
  for_each_pixel(canvas, circle, [&](int x, int y, double dx, double dy) {
    const double distance = std::sqrt(dx * dx + dy * dy);
    const float coverage = circle_coverage(circle.radius, distance);
    if (coverage <= 0.0F) return;
    const float inner = rim > 0.0 ? circle_coverage(circle.radius - rim, distance) : 1.0F;
    canvas.add_beside(x, y, mix(edge, colour, inner), coverage);
  });
}

void draw_ball(Canvas& canvas, const Circle& circle, const Colour& colour) {
  const double radius = std::max(circle.radius, 0.5);
  for_each_pixel(canvas, {circle.x, circle.y, radius}, [&](int x, int y, double dx, double dy) {
    if (canvas.coverage(x, y) > kCovered) return;
    const double square = dx * dx + dy * dy;
    const float coverage = circle_coverage(radius, std::sqrt(square));
    if (coverage <= 0.0F) return;
    const double depth = std::sqrt(std::max(0.0, radius * radius - square));
    const double light = (-0.42 * dx - 0.55 * dy + 0.72 * depth) / radius;
    const double shade = radius < 1.5 ? 0.85 : 0.22 + 0.78 * std::max(0.0, light);
    const double gloss = radius < 4.0 ? 0.0 : 0.25 * std::pow(std::max(0.0, light), 30.0);
    canvas.add_behind(x, y,
                      mix(colour.scaled(static_cast<float>(shade)), {1.0F, 1.0F, 1.0F},
                          static_cast<float>(gloss)),
                      coverage);
  });
}

CoveredTiles::CoveredTiles(const Canvas& canvas)
    : across_((canvas.width() + kSide - 1) / kSide), down_((canvas.height() + kSide - 1) / kSide) {}

void CoveredTiles::update(const Canvas& canvas) {
  covered_.assign(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_), true);
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) {
      if (canvas.coverage(x, y) <= kCovered) covered_[index(x / kSide, y / kSide)] = false;
    }
  }
}

bool CoveredTiles::hides(const Circle& circle) const {
  if (covered_.empty()) return false;
  const auto tile = [](double pixel, int end) {
    return static_cast<int>(std::clamp(std::floor(pixel / kSide), 0.0, end - 1.0));
  };
  const double reach = circle.radius + 1.0;
  if (!std::isfinite(circle.x + circle.y + reach)) return true;
  for (int y = tile(circle.y - reach, down_); y <= tile(circle.y + reach, down_); ++y) {
    for (int x = tile(circle.x - reach, across_); x <= tile(circle.x + reach, across_); ++x) {
      if (!covered_[index(x, y)]) return false;
    }
  }
  return true;
}

std::size_t CoveredTiles::index(int x, int y) const {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(across_) +
         static_cast<std::size_t>(x);
}

}  // namespace barchan
