#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include <barchan/core/io/canvas.hpp>
#include <barchan/core/io/circles.hpp>
#include <barchan/core/io/font.hpp>
#include <barchan/core/io/picture.hpp>

namespace barchan {
namespace {

constexpr int kMargin = 28;
constexpr int kBarHeight = 16;
constexpr int kTextScale = 2;
constexpr int kTextHeight = kGlyphHeight * kTextScale;
constexpr double kTallest = 1.5;  ///< height of the scene over the image's width

constexpr double kTiny = 1.5;  ///< radius [pixels] below which gaps between particles are closed
constexpr float kTinyGain = 1.5F;  ///< more than one over the solid fraction of a packing

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
  if (!(range.lo <= range.hi)) range = {input.lo[axis], input.hi[axis]};
  // What has flown away (or is not a number) must not shrink the rest to nothing.
  const double half = 0.5 * (input.hi[axis] - input.lo[axis]);
  return {std::max(range.lo, input.lo[axis] - half), std::min(range.hi, input.hi[axis] + half)};
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
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double value : input.values) {
    if (!std::isfinite(value)) continue;
    range = {std::min(range.lo, value), std::max(range.hi, value)};
  }
  if (!(range.lo <= range.hi)) return {0.0, 1.0};
  if (range.lo >= 0.0 && range.lo < 0.05 * range.hi) range.lo = 0.0;
  return range;
}

Colour colour_of(const PictureInput& input, std::size_t i, const Range& range) {
  if (input.values.empty()) return kind_colour(0);
  const double value = input.values[i];
  if (input.values_are_kinds)
    return kind_colour(std::abs(value) < 1e9 ? static_cast<int>(value) : 0);
  return colour_map(range.hi > range.lo ? (value - range.lo) / (range.hi - range.lo) : 0.0);
}

void draw_disks(Canvas& canvas, const PictureInput& input, const View& view, const Range& range) {
  for (std::size_t i = 0; i < input.positions.size(); ++i) {
    const Vec3& p = input.positions[i];
    draw_disk(canvas, {view.x(p), view.y(p), input.radii[i] * view.scale},
              colour_of(input, i, range));
  }
}

void draw_balls(Canvas& canvas, const PictureInput& input, const View& view, const Range& range) {
  std::vector<std::pair<double, std::uint32_t>> nearest_first;
  nearest_first.reserve(input.positions.size());
  for (std::uint32_t i = 0; i < input.positions.size(); ++i) {
    nearest_first.push_back({input.positions[i].y() - input.radii[i], i});
  }
  std::sort(nearest_first.begin(), nearest_first.end());
  const double depth = input.hi.y() - input.lo.y();
  const std::size_t between_updates = std::max<std::size_t>(20000, nearest_first.size() / 40);
  CoveredTiles covered(canvas);
  for (std::size_t n = 0; n < nearest_first.size(); ++n) {
    if (n > 0 && n % between_updates == 0) covered.update(canvas);
    const std::uint32_t i = nearest_first[n].second;
    const Vec3& p = input.positions[i];
    const Circle circle{view.x(p), view.y(p), input.radii[i] * view.scale};
    if (covered.hides(circle)) continue;
    const double far = depth > 0.0 ? std::clamp((p.y() - input.lo.y()) / depth, 0.0, 1.0) : 0.0;
    const Colour colour = colour_of(input, i, range);
    draw_ball(canvas, circle, colour.scaled(static_cast<float>(1.0 - 0.55 * far)));
  }
}

void draw_lines(Canvas& canvas, const PictureInput& input, const View& view) {
  const Vec3 lo(std::max(input.lo.x(), view.across.lo), 0, 0);
  Vec3 a = lo, b = lo;
  a[view.up] = std::max(input.lo[view.up], view.upward.lo);
  b.x() = std::min(input.hi.x(), view.across.hi);
  b[view.up] = std::min(input.hi[view.up], view.upward.hi);
  const PixelPoint corners[] = {{view.x(a), view.y(a)},
                                {view.x(b), view.y(a)},
                                {view.x(b), view.y(b)},
                                {view.x(a), view.y(b)}};
  for (std::size_t k = 0; k < 4; ++k) {
    canvas.line(corners[k], corners[(k + 1) % 4], {1.0, kFrame, true});
  }
  for (const PictureLine& line : input.lines) {
    canvas.line({view.x(line.from), view.y(line.from)}, {view.x(line.to), view.y(line.to)},
                {3.0, kInk, false});
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
  if (input.dimension == 2) {
    draw_disks(canvas, input, view, range);
  } else {
    draw_balls(canvas, input, view, range);
  }
  double mean_radius = 0.0;
  for (const double radius : input.radii) mean_radius += radius / static_cast<double>(count);
  canvas.put_on_white(mean_radius * view.scale < kTiny ? kTinyGain : 1.0F);
  draw_lines(canvas, input, view);
  canvas.text(kMargin, kMargin, input.title, kTextScale, kInk);
  if (has_scale) draw_scale(canvas, input, range, scene_end);
  if (input.values_are_kinds) draw_kinds(canvas, input, scene_end);
  canvas.write_png(path);
}

}  // namespace barchan
