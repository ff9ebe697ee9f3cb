#pragma once

#include <span>
#include <string>
#include <vector>

#include <barchan/core/base/vec.hpp>

namespace barchan {

struct PictureLine {
  Vec3 from = Vec3::Zero();  ///< [m]
  Vec3 to = Vec3::Zero();    ///< [m]
};

/// What a picture shows, in the caller's memory.
struct PictureInput {
  int dimension = 2;
  Vec3 lo = Vec3::Zero();  ///< domain [m]: drawn as a frame
  Vec3 hi = Vec3::Zero();
  std::span<const Vec3> positions;  ///< [m]
  std::span<const double> radii;    ///< [m]
  std::span<const double> values;   ///< colour of each particle; empty = all alike
  /// Whole numbers from 0, each a colour of its own, instead of a scale.
  bool values_are_kinds = false;
  std::vector<std::string> kinds;  ///< their names, for the legend
  std::string label;               ///< of the colour bar, e.g. "speed [m/s]"
  std::string title;
  std::vector<PictureLine> lines;  ///< walls and plates
  int width = 1200;                ///< of the image [pixels]
};

/// Draws particles as a PNG: 2D disks from above; 3D spheres from the side (along +y, z up),
/// shaded. The view is the domain's part that holds particles and lines. One pass over the
/// particles: 10^6 in about a second.
/// @pre there are as many radii (and values, unless empty) as positions
/// @throws RunError when the file cannot be written
void write_picture(const std::string& path, const PictureInput& input);

}  // namespace barchan
