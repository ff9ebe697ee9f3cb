#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <barchan/core/kernels/pair_job.hpp>
#include <barchan/core/model/model.hpp>

namespace barchan {

/// One periodic image of a wall: its point is image[a] lengths of the box further along axis a.
using WallImage = std::array<std::int32_t, 3>;
inline constexpr std::int32_t kFarthestImage = 1 << 28;  ///< along any axis

/// The point of a wall that is nearest to a position.
struct WallFoot {
  double distance = 0.0;        ///< [m]; of a plane the height over it, below zero behind it
  Vec3 to_foot = Vec3::Zero();  ///< from the position [m]
  double inside = 0.0;  ///< how far the foot is from the wall's rim; infinite on a plane [m]
};

/// Shape of a wall in a periodic box, apart from where it is.
///
/// A plane runs along the periodic axes and is its own image. A plate has an image in every period:
///
///     |          ──plate── |          ──image── |      a position near the border feels both
///
/// A plate along a periodic axis that is as wide as the box closes on itself: it has no ends there,
/// and one image only.
template <int Dim>
class WallShape {
 public:
  WallShape(const WallSpec& spec, const PeriodicBox& box);

  /// @param point  of the wall, wherever it has moved to [m]. @param x  a position [m]
  [[nodiscard]] WallFoot foot(const Vec3& point, const WallImage& image, const double* x) const;
  /// From the wall's point, of this image, to a foot [m].
  [[nodiscard]] Vec3 arm(const Vec3& point, const WallImage& image, const double* x,
                         const WallFoot& foot) const;
  /// Of all images the nearest one.
  [[nodiscard]] WallFoot foot(const Vec3& point, const double* x) const;
  /// Calls visit(image) for the images that are nearer than `reach`, in ascending order.
  template <class Visit>
  void for_each_near(const Vec3& point, const double* x, double reach, Visit&& visit) const;
  /// The same image as seen from a position that has been wrapped from `before` to `after`.
  [[nodiscard]] WallImage seen_after(const WallImage& image, const double* before,
                                     const double* after) const;

  [[nodiscard]] const Vec3& normal() const { return normal_; }

 private:
  /// From a position to the image's point.
  [[nodiscard]] Vec3 to_point(const Vec3& point, const WallImage& image, const double* x) const {
    Vec3 d = Vec3::Zero();
    for (int c = 0; c < Dim; ++c)
      d[c] = (point[c] - x[c]) + image[static_cast<std::size_t>(c)] * box_.length[c];
    return d;
  }
  /// Images along one axis: [lo, hi].
  struct Stretch {
    std::int32_t lo = 0, hi = 0;
  };
  [[nodiscard]] Stretch images_near(int axis, double to_point, double reach) const;
  void close_along(const Vec3& direction, double& half);

  bool is_plane_;
  Vec3 normal_, along_, across_;
  double half_width_ = 0.0, half_depth_ = 0.0;  ///< infinite where the plate closes on itself
  PeriodicBox box_;
  std::array<bool, 3> has_images_{};  ///< along a periodic axis
};

template <int Dim>
template <class Visit>
void WallShape<Dim>::for_each_near(const Vec3& point, const double* x, double reach,
                                   Visit&& visit) const {
  std::array<Stretch, 3> near{};
  for (int c = 0; c < Dim; ++c) {
    const auto a = static_cast<std::size_t>(c);
    if (has_images_[a]) near[a] = images_near(c, point[c] - x[c], reach);
  }
  WallImage image{};
  for (image[0] = near[0].lo; image[0] <= near[0].hi; ++image[0]) {
    for (image[1] = near[1].lo; image[1] <= near[1].hi; ++image[1]) {
      for (image[2] = near[2].lo; image[2] <= near[2].hi; ++image[2]) {
        if (foot(point, image, x).distance < reach) visit(image);
      }
    }
  }
}

extern template class WallShape<2>;
extern template class WallShape<3>;

}  // namespace barchan
