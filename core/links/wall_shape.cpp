#include <barchan/core/links/wall_shape.hpp>

#include <limits>

namespace barchan {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
/// A width that is the box's but for rounding closes.
constexpr double kCloses = 1.0 - 1e-9;
/// A direction along an axis but for rounding.
constexpr double kParallel = 1.0 - 1e-12;

/// The width of a plate in 3D runs along the coordinate axis least aligned with the normal, turned
/// into the plane; the depth across `normal` and `along`.
void in_plane_axes(const Vec3& n, Vec3& along, Vec3& across) {
  int least = 0;
  for (int c = 1; c < 3; ++c) {
    if (std::fabs(n[c]) < std::fabs(n[least])) least = c;
  }
  Vec3 axis = Vec3::Zero();
  axis[least] = 1.0;
  along = axis - n[least] * n;
  along /= std::sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
  across = Vec3(n[1] * along[2] - n[2] * along[1], n[2] * along[0] - n[0] * along[2],
                n[0] * along[1] - n[1] * along[0]);
}

double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

template <int Dim>
WallShape<Dim>::WallShape(const WallSpec& spec, const PeriodicBox& box)
    : is_plane_(spec.kind == WallKind::Plane), normal_(spec.normal), box_(box) {
  if constexpr (Dim == 2)
    along_ = Vec3(-normal_[1], normal_[0], 0.0), across_ = Vec3::Zero();
  else
    in_plane_axes(normal_, along_, across_);
  if (is_plane_) return;
  half_width_ = 0.5 * spec.width;
  half_depth_ = Dim == 3 ? 0.5 * spec.depth : 0.0;
  for (int c = 0; c < Dim; ++c) has_images_[static_cast<std::size_t>(c)] = box_.inverse[c] != 0.0;
  close_along(along_, half_width_);
  if constexpr (Dim == 3) close_along(across_, half_depth_);
}

template <int Dim>
void WallShape<Dim>::close_along(const Vec3& direction, double& half) {
  for (int c = 0; c < Dim; ++c) {
    const auto a = static_cast<std::size_t>(c);
    if (!has_images_[a] || std::fabs(direction[c]) < kParallel) continue;
    if (2.0 * half < kCloses * box_.length[c]) continue;
    has_images_[a] = false;
    half = kEndless;
    return;
  }
}

template <int Dim>
WallFoot WallShape<Dim>::foot(const Vec3& point, const WallImage& image, const double* x) const {
  const Vec3 d = to_point(point, image, x);
  const double height = -dot(d, normal_);  // of the position over the wall
  WallFoot foot;
  foot.inside = kEndless;
  if (is_plane_) {
    foot.distance = height;
    for (int c = 0; c < Dim; ++c) foot.to_foot[c] = -height * normal_[c];
  } else {
    const double a = dot(d, along_), b = dot(d, across_);
    const double beyond_a =
        half_width_ == kEndless ? 0.0 : a - std::clamp(a, -half_width_, half_width_);
    const double beyond_b =
        half_depth_ == kEndless ? 0.0 : b - std::clamp(b, -half_depth_, half_depth_);
    foot.inside = half_width_ - std::fabs(a);
    if constexpr (Dim == 3) foot.inside = std::min(foot.inside, half_depth_ - std::fabs(b));
    foot.inside = std::max(foot.inside, 0.0);
    double d2 = 0.0;
    for (int c = 0; c < Dim; ++c) {
      foot.to_foot[c] = -height * normal_[c] + beyond_a * along_[c] + beyond_b * across_[c];
      d2 += foot.to_foot[c] * foot.to_foot[c];
    }
    foot.distance = std::sqrt(d2);
  }
  return foot;
}

template <int Dim>
Vec3 WallShape<Dim>::arm(const Vec3& point, const WallImage& image, const double* x,
                         const WallFoot& foot) const {
  Vec3 arm = foot.to_foot - to_point(point, image, x);
  for (int c = 0; c < Dim; ++c) {
    if (box_.inverse[c] != 0.0 && !has_images_[static_cast<std::size_t>(c)])
      arm[c] = box_.nearest(arm[c], c);
  }
  return arm;
}

template <int Dim>
WallFoot WallShape<Dim>::foot(const Vec3& point, const double* x) const {
  // No image is nearest that is farther than the one with the nearest point.
  WallImage image{};
  for (int c = 0; c < Dim; ++c) {
    const auto a = static_cast<std::size_t>(c);
    const double boxes = std::rint((x[c] - point[c]) * box_.inverse[c]);
    if (has_images_[a] && std::fabs(boxes) < kFarthestImage)
      image[a] = static_cast<std::int32_t>(boxes);
  }
  WallFoot nearest = foot(point, image, x);
  for_each_near(point, x, nearest.distance, [&](const WallImage& other) {
    const WallFoot here = foot(point, other, x);
    if (here.distance < nearest.distance) nearest = here;
  });
  return nearest;
}

template <int Dim>
typename WallShape<Dim>::Stretch WallShape<Dim>::images_near(int axis, double to_point,
                                                             double reach) const {
  double extent = reach;  // an endless direction runs along another axis
  if (half_width_ != kEndless) extent += std::fabs(along_[axis]) * half_width_;
  if (half_depth_ != kEndless) extent += std::fabs(across_[axis]) * half_depth_;
  const double lo = std::ceil((-extent - to_point) * box_.inverse[axis]),
               hi = std::floor((extent - to_point) * box_.inverse[axis]);
  if (!(lo > -kFarthestImage && hi < kFarthestImage)) return {0, -1};
  return {static_cast<std::int32_t>(lo), static_cast<std::int32_t>(hi)};
}

template <int Dim>
WallImage WallShape<Dim>::seen_after(const WallImage& image, const double* before,
                                     const double* after) const {
  WallImage seen = image;
  for (int c = 0; c < Dim; ++c) {
    const auto a = static_cast<std::size_t>(c);
    if (has_images_[a])
      seen[a] -= static_cast<std::int32_t>(std::rint((before[c] - after[c]) * box_.inverse[c]));
  }
  return seen;
}

template class WallShape<2>;
template class WallShape<3>;

}  // namespace barchan
