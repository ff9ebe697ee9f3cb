#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include <barchan/core/io/canvas.hpp>
#include <barchan/core/io/font.hpp>
#include <barchan/core/io/picture.hpp>

namespace barchan {
namespace {

constexpr int kMargin = 28;
constexpr int kBarHeight = 16;
constexpr int kTextScale = 2;
constexpr int kTextHeight = kGlyphHeight * kTextScale;
constexpr double kTallest = 1.5;  ///< height of the scene over the image's width

const Colour kInk = Colour::from_hex(0x3a3f47);
const Colour kFrame = Colour::from_hex(0xb4b9c0);

struct Range {
  double lo = 0.0;
  double hi = 0.0;
};

/// From metres to pixels: x to the right, the last axis up.
struct View {
  int up = 1;
  Range across, upward;
  double scale = 1.0;  ///< pixels per metre
  double left = 0.0, bottom = 0.0;

  [[nodiscard]] double x(const Vec3& p) const { return left + (p.x() - across.lo) * scale; }
  [[nodiscard]] double y(const Vec3& p) const { return bottom - (p[up] - upward.lo) * scale; }
};

/// The part of [lo, hi] that is worth showing: what is there and some room, never a long empty
/// stretch.
Range shown(double domain_lo, double domain_hi, const Range& content) {
  const double room = 0.06 * (content.hi - content.lo);
  Range range{std::min(content.lo, std::max(domain_lo, content.lo - room)),
              std::max(content.hi, std::min(domain_hi, content.hi + room))};
  const double domain = domain_hi - domain_lo;
  if (range.hi - range.lo > 0.75 * domain)
    range = {std::min(range.lo, domain_lo), std::max(range.hi, domain_hi)};
  if (!(range.hi > range.lo)) range.hi = range.lo + 1.0;
  return range;
}

Range content_range(const PictureInput& input, int axis) {
  Range range{input.hi[axis], input.lo[axis]};
  for (std::size_t i = 0; i < input.positions.size(); ++i) {
    range.lo = std::min(range.lo, input.positions[i][axis] - input.radii[i]);
    range.hi = std::max(range.hi, input.positions[i][axis] + input.radii[i]);
  }
  for (const PictureLine& line : input.lines) {
    range.lo = std::min({range.lo, line.from[axis], line.to[axis]});
    range.hi = std::max({range.hi, line.from[axis], line.to[axis]});
  }
  if (range.lo > range.hi) range = {input.lo[axis], input.hi[axis]};
  return range;
}

View make_view(const PictureInput& input, int top) {
  View view;
  view.up = input.dimension == 2 ? 1 : 2;
  view.across = shown(input.lo.x(), input.hi.x(), content_range(input, 0));
  view.upward = shown(input.lo[view.up], input.hi[view.up], content_range(input, view.up));
  const double room = input.width - 2.0 * kMargin;
  const double width = view.across.hi - view.across.lo;
  const double height = view.upward.hi - view.upward.lo;
  view.scale = std::min(room / width, kTallest * room / height);
  view.left = kMargin + 0.5 * (room - width * view.scale);
  view.bottom = top + height * view.scale;
  return view;
}

Range value_range(const PictureInput& input) {
  if (input.values.empty() || input.values_are_kinds) return {0.0, 1.0};
  const auto [lo, hi] = std::minmax_element(input.values.begin(), input.values.end());
  return {*lo, *hi};
}

Colour colour_of(const PictureInput& input, std::size_t i, const Range& range) {
  if (input.values.empty()) return kind_colour(0);
  const double value = input.values[i];
  if (input.values_are_kinds) return kind_colour(static_cast<int>(value));
  return colour_map(range.hi > range.lo ? (value - range.lo) / (range.hi - range.lo) : 0.0);
}

/// Coverage of a pixel whose centre is at `distance` from the centre of a circle [pixels].
float circle_coverage(double radius, double distance) {
  return static_cast<float>(std::clamp(radius + 0.5 - distance, 0.0, 1.0));
}

struct Circle {
  double x, y, radius;  ///< [pixels]
};

template <class Use>
void for_each_pixel(const Canvas& canvas, const Circle& circle, Use use) {
  const double reach = circle.radius + 0.5;
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
  const double area = 3.14159265 * circle.radius * circle.radius;
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

/// A ball lit from the upper left, in front of all that follows.
void draw_ball(Canvas& canvas, const Circle& circle, const Colour& colour) {
  const double radius = std::max(circle.radius, 0.5);
  for_each_pixel(canvas, {circle.x, circle.y, radius}, [&](int x, int y, double dx, double dy) {
    if (canvas.coverage(x, y) > 0.99F) return;
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

void draw_particles(Canvas& canvas, const PictureInput& input, const View& view,
                    const Range& range) {
  std::vector<std::uint32_t> order(input.positions.size());
  std::iota(order.begin(), order.end(), 0U);
  if (input.dimension == 3) {  // nearest first: least y
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      const double ya = input.positions[a].y() - input.radii[a],
                   yb = input.positions[b].y() - input.radii[b];
      return ya != yb ? ya < yb : a < b;
    });
  }
  const double depth = input.hi.y() - input.lo.y();
  for (const std::uint32_t i : order) {
    const Vec3& p = input.positions[i];
    const Circle circle{view.x(p), view.y(p), input.radii[i] * view.scale};
    const Colour colour = colour_of(input, i, range);
    if (input.dimension == 2) {
      draw_disk(canvas, circle, colour);
    } else {
      const double far = depth > 0.0 ? std::clamp((p.y() - input.lo.y()) / depth, 0.0, 1.0) : 0.0;
      draw_ball(canvas, circle, colour.scaled(static_cast<float>(1.0 - 0.55 * far)));
    }
  }
}

void draw_lines(Canvas& canvas, const PictureInput& input, const View& view) {
  const Vec3 lo(std::max(input.lo.x(), view.across.lo), 0, 0);
  Vec3 a = lo, b = lo;
  a[view.up] = std::max(input.lo[view.up], view.upward.lo);
  b.x() = std::min(input.hi.x(), view.across.hi);
  b[view.up] = std::min(input.hi[view.up], view.upward.hi);
  canvas.line(view.x(a), view.y(a), view.x(b), view.y(a), 1.0, kFrame);
  canvas.line(view.x(a), view.y(b), view.x(b), view.y(b), 1.0, kFrame);
  canvas.line(view.x(a), view.y(a), view.x(a), view.y(b), 1.0, kFrame);
  canvas.line(view.x(b), view.y(a), view.x(b), view.y(b), 1.0, kFrame);
  for (const PictureLine& line : input.lines) {
    canvas.line(view.x(line.from), view.y(line.from), view.x(line.to), view.y(line.to), 3.0, kInk);
  }
}

void draw_scale(Canvas& canvas, const PictureInput& input, const Range& range, int top) {
  const int width = std::min(420, canvas.width() / 2);
  const int left = (canvas.width() - width) / 2;
  for (int x = 0; x < width; ++x) {
    canvas.rectangle(left + x, top, left + x + 1, top + kBarHeight, colour_map((x + 0.5) / width));
  }
  const std::string low = fmt::format("{:.3g}", range.lo), high = fmt::format("{:.3g}", range.hi);
  const int text_top = top + (kBarHeight - 7 * kTextScale) / 2;
  canvas.text(left - 12 - text_width(low, kTextScale), text_top, low, kTextScale, kInk);
  canvas.text(left + width + 12, text_top, high, kTextScale, kInk);
  canvas.text((canvas.width() - text_width(input.label, kTextScale)) / 2, top + kBarHeight + 8,
              input.label, kTextScale, kInk);
}

void draw_kinds(Canvas& canvas, const PictureInput& input, int top) {
  int width = 0;
  for (const std::string& kind : input.kinds)
    width += kBarHeight + 10 + text_width(kind, kTextScale) + 32;
  int x = (canvas.width() - width + 32) / 2;
  for (std::size_t k = 0; k < input.kinds.size(); ++k) {
    canvas.rectangle(x, top, x + kBarHeight, top + kBarHeight, kind_colour(static_cast<int>(k)));
    x += kBarHeight + 10;
    canvas.text(x, top + (kBarHeight - 7 * kTextScale) / 2, input.kinds[k], kTextScale, kInk);
    x += text_width(input.kinds[k], kTextScale) + 32;
  }
}

}  // namespace

void write_picture(const std::string& path, const PictureInput& input) {
  const std::size_t count = input.positions.size();
  if (input.radii.size() != count || (!input.values.empty() && input.values.size() != count)) {
    throw std::logic_error("picture: radii and values must be as many as positions");
  }
  const int top = kMargin + (input.title.empty() ? 0 : kTextHeight + 16);
  const View view = make_view(input, top);
  const bool has_scale = !input.values.empty() && !input.values_are_kinds;
  const int foot =
      has_scale ? kBarHeight + 12 + kTextHeight : (input.kinds.empty() ? 0 : kBarHeight);
  const int scene_end = static_cast<int>(std::ceil(view.bottom)) + (foot > 0 ? 22 : 0);
  Canvas canvas(input.width, scene_end + foot + kMargin);

  const Range range = value_range(input);
  draw_particles(canvas, input, view, range);
  canvas.put_on_white();
  draw_lines(canvas, input, view);
  canvas.text(kMargin, kMargin, input.title, kTextScale, kInk);
  if (has_scale) draw_scale(canvas, input, range, scene_end);
  if (input.values_are_kinds) draw_kinds(canvas, input, scene_end);
  canvas.write_png(path);
}

}  // namespace barchan
