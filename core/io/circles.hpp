#pragma once

#include <vector>

#include <barchan/core/io/canvas.hpp>

namespace barchan {

/// In pixels of a canvas.
struct Circle {
  double x = 0.0;
  double y = 0.0;
  double radius = 0.0;
};

/// A flat disk with a darker rim, beside what is there; below a pixel's size it spreads its area.
/// Whatever is not finite is not drawn; the same for balls.
void draw_disk(Canvas& canvas, const Circle& circle, const Colour& colour);

/// A ball lit from the upper left, behind what is there.
void draw_ball(Canvas& canvas, const Circle& circle, const Colour& colour);

/// Square tiles of a canvas that are covered all over, so that what lies behind need not be drawn.
class CoveredTiles {
 public:
  explicit CoveredTiles(const Canvas& canvas);

  void update(const Canvas& canvas);
  [[nodiscard]] bool hides(const Circle& circle) const;

 private:
  [[nodiscard]] std::size_t index(int x, int y) const;

  int across_;
  int down_;
  std::vector<bool> covered_;
};

}  // namespace barchan
