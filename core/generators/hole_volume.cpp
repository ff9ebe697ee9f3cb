#include <barchan/core/generators/hole_volume.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <barchan/core/generators/disk_union.hpp>
#include <barchan/core/generators/grain.hpp>

namespace barchan {
namespace {

using Holes = std::vector<Hole>;

Vec3 period_of(const PairSpace& box) {
  Vec3 period = Vec3::Zero();
  for (int axis = 0; axis < box.dimension; ++axis) {
    if (box.periodic[static_cast<std::size_t>(axis)]) period[axis] = box.hi[axis] - box.lo[axis];
  }
  return period;
}

bool reaches_into(const Hole& hole, const PairSpace& box) {
  double square = 0.0;
  for (int axis = 0; axis < box.dimension; ++axis) {
    const double gap =
        std::max({0.0, box.lo[axis] - hole.center[axis], hole.center[axis] - box.hi[axis]});
    square += gap * gap;
  }
  return square < hole.radius * hole.radius;
}

bool lies_in(const Hole& hole, const PairSpace& box) {
  for (int axis = 0; axis < box.dimension; ++axis) {
    if (hole.center[axis] - hole.radius < box.lo[axis] ||
        hole.center[axis] + hole.radius > box.hi[axis])
      return false;
  }
  return true;
}

bool overlap(const Hole& a, const Hole& b, int dimension) {
  double square = 0.0;
  for (int axis = 0; axis < dimension; ++axis)
    square += (a.center[axis] - b.center[axis]) * (a.center[axis] - b.center[axis]);
  return square < (a.radius + b.radius) * (a.radius + b.radius);
}

/// The holes by the groups that overlap: label of each.
std::vector<std::size_t> groups_of(const Holes& holes, int dimension) {
  std::vector<std::size_t> group(holes.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (std::size_t i = 0; i < holes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (group[i] == group[j] || !overlap(holes[i], holes[j], dimension)) continue;
      std::replace(group.begin(), group.end(), std::max(group[i], group[j]),
                   std::min(group[i], group[j]));
    }
  }
  return group;
}

/// Holes that overlap, in a box of three dimensions: the area of a cut is known in closed form, and
/// is integrated along the axis on which they are longest.
class BallUnion {
 public:
  BallUnion(const PairSpace& box, const Holes& holes) : holes_(holes), lo_(box.hi), hi_(box.lo) {
    for (const Hole& hole : holes) {
      lo_ = lo_.cwiseMin((hole.center.array() - hole.radius).matrix());
      hi_ = hi_.cwiseMax((hole.center.array() + hole.radius).matrix());
    }
    lo_ = lo_.cwiseMax(box.lo);
    hi_ = hi_.cwiseMin(box.hi);
    for (int axis = 1; axis < 3; ++axis) {
      if (hi_[axis] - lo_[axis] > hi_[axis_] - lo_[axis_]) axis_ = axis;
    }
    tolerance_ = kTolerance * (hi_ - lo_).prod();
  }

  [[nodiscard]] double volume() const {
    std::vector<double> ends{lo_[axis_], hi_[axis_]};
    for (const Hole& hole : holes_) {
      for (const double end : {hole.center[axis_] - hole.radius, hole.center[axis_] + hole.radius})
        if (end > lo_[axis_] && end < hi_[axis_]) ends.push_back(end);
    }
    std::sort(ends.begin(), ends.end());
    double sum = 0.0;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      if (!(ends[k + 1] > ends[k])) continue;
      const Panel panel{0.5 * (ends[k] + ends[k + 1]), 0.5 * (ends[k + 1] - ends[k])};
      constexpr double kQuarter = 0.5 * std::numbers::pi;
      const double share = tolerance_ * (ends[k + 1] - ends[k]) / (hi_[axis_] - lo_[axis_]);
      sum += refined(panel, -kQuarter, kQuarter, gauss(panel, -kQuarter, kQuarter), share, 0);
    }
    return sum;
  }

 private:
  static constexpr double kTolerance = 1e-9;
  static constexpr int kMostHalvings = 30;

  /// A stretch of the axis as middle + half·sin(angle), which takes the sting out of roots at its
  /// ends.
  struct Panel {
    double middle, half;
  };

  [[nodiscard]] double area(double at) const {
    const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
    std::vector<Disk> disks;
    for (const Hole& hole : holes_) {
      const double height = at - hole.center[axis_];
      const double square = (hole.radius - height) * (hole.radius + height);
      if (square > 0.0)
        disks.push_back({hole.center[u] - lo_[u], hole.center[v] - lo_[v], std::sqrt(square)});
    }
    return disk_union_area(disks, {{0.0, 0.0}, {hi_[u] - lo_[u], hi_[v] - lo_[v]}});
  }

  /// Gauss and Legendre's rule with eight points.
  [[nodiscard]] double gauss(const Panel& panel, double from, double to) const {
    constexpr double kPoints[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                  0.9602898564975363};
    constexpr double kWeights[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                   0.1012285362903763};
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) {
      for (const double side : {-1.0, 1.0}) {
        const double angle = middle + side * half * kPoints[k];
        sum += kWeights[k] * std::cos(angle) * area(panel.middle + panel.half * std::sin(angle));
      }
    }
    return sum * half * panel.half;
  }

  [[nodiscard]] double refined(const Panel& panel, double from, double to, double whole,
                               double tolerance, int depth) const {
    const double middle = 0.5 * (from + to);
    const double left = gauss(panel, from, middle), right = gauss(panel, middle, to);
    if (std::abs(left + right - whole) <= tolerance || depth == kMostHalvings) return left + right;
    return refined(panel, from, middle, left, 0.5 * tolerance, depth + 1) +
           refined(panel, middle, to, right, 0.5 * tolerance, depth + 1);
  }

  const Holes& holes_;
  Vec3 lo_, hi_;  ///< of what may be taken [m]
  int axis_ = 0;
  double tolerance_ = 0.0;  ///< [m³]
};

double union_volume(const PairSpace& box, const Holes& holes) {
  if (box.dimension == 3) return BallUnion(box, holes).volume();
  std::vector<Disk> disks;
  for (const Hole& hole : holes) {
    const Vec3 at = hole.center - box.lo;
    disks.push_back({at.x(), at.y(), hole.radius});
  }
  const Vec3 size = box.hi - box.lo;
  return disk_union_area(disks, {{0.0, 0.0}, {size.x(), size.y()}});
}

}  // namespace

std::vector<Hole> with_images(std::span<const Hole> holes, const PairSpace& box,
                              const Vec3& period) {
  Holes all(holes.begin(), holes.end());
  for (int axis = 0; axis < box.dimension; ++axis) {
    if (!(period[axis] > 0.0)) continue;
    const std::size_t count = all.size();
    for (std::size_t i = 0; i < count; ++i) {
      // The copy whose centre is nearest to the box, and those on its two sides.
      const double middle = 0.5 * (box.lo[axis] + box.hi[axis]);
      const double turns = std::nearbyint((middle - all[i].center[axis]) / period[axis]);
      const Hole original = all[i];
      all[i].center[axis] += turns * period[axis];
      for (const double side : {-1.0, 1.0}) {
        Hole image = original;
        image.center[axis] += (turns + side) * period[axis];
        if (reaches_into(image, box)) all.push_back(image);
      }
    }
  }
  return all;
}

double hole_volume(const PairSpace& box, std::span<const Hole> holes) {
  Holes near = with_images(holes, box, period_of(box));
  std::erase_if(near, [&](const Hole& hole) { return !reaches_into(hole, box); });
  const std::vector<std::size_t> group = groups_of(near, box.dimension);
  double sum = 0.0;
  for (std::size_t first = 0; first < near.size(); ++first) {
    if (group[first] != first) continue;
    Holes together;
    for (std::size_t i = first; i < near.size(); ++i) {
      if (group[i] == first) together.push_back(near[i]);
    }
    const bool is_simple = together.size() == 1 && lies_in(together.front(), box);
    sum += is_simple ? solid_volume(together.front().radius, box.dimension)
                     : union_volume(box, together);
  }
  return sum;
}

}  // namespace barchan
