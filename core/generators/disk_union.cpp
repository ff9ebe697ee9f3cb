#include <barchan/core/generators/disk_union.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace barchan {
namespace {

/// Lower or upper end of a covered interval: an arc of a disk, or a side of the rectangle.
struct End {
  double at = 0.0;             ///< ordinate in the middle of the strip
  const Disk* disk = nullptr;  ///< null: the side at `at`
  double sign = 0.0;           ///< of the arc: 1 upper, -1 lower
};

struct Interval {
  End lower, upper;
};

/// The integral of sqrt(1 - t²) from 0 to t.
double half_disk(double t) {
  t = std::clamp(t, -1.0, 1.0);
  return 0.5 * (t * std::sqrt((1.0 - t) * (1.0 + t)) + std::asin(t));
}

/// The integral of an end's ordinate over [a, b].
double integral(const End& end, double a, double b) {
  if (end.disk == nullptr) return end.at * (b - a);
  const Disk& disk = *end.disk;
  const double arc = half_disk((b - disk.x) / disk.radius) - half_disk((a - disk.x) / disk.radius);
  return disk.y * (b - a) + end.sign * disk.radius * disk.radius * arc;
}

class Sweep {
 public:
  Sweep(std::span<const Disk> disks, const Rectangle& rectangle)
      : disks_(disks.begin(), disks.end()), rectangle_(rectangle) {
    std::sort(disks_.begin(), disks_.end(),
              [](const Disk& a, const Disk& b) { return a.x - a.radius < b.x - b.radius; });
    find_abscissae();
  }

  double area() {
    double sum = 0.0;
    std::size_t next = 0;
    std::vector<const Disk*> begun;
    for (std::size_t k = 0; k + 1 < abscissae_.size(); ++k) {
      const double a = abscissae_[k], b = abscissae_[k + 1], middle = 0.5 * (a + b);
      if (!(a < middle && middle < b)) continue;
      while (next < disks_.size() && disks_[next].x - disks_[next].radius < middle)
        begun.push_back(&disks_[next++]);
      std::erase_if(begun, [&](const Disk* d) { return d->x + d->radius <= middle; });
      sum += strip(begun, a, b);
    }
    return sum;
  }

 private:
  void find_abscissae() {
    for (int end = 0; end < 2; ++end)
      abscissae_.push_back(end == 0 ? rectangle_.lo[0] : rectangle_.hi[0]);
    for (std::size_t i = 0; i < disks_.size(); ++i) {
      const Disk& disk = disks_[i];
      add(disk.x, disk.radius);
      for (const double side : {rectangle_.lo[1], rectangle_.hi[1]}) {
        const double height = side - disk.y;
        add(disk.x, std::sqrt((disk.radius - height) * (disk.radius + height)));
      }
      for (std::size_t j = i + 1; j < disks_.size(); ++j) {
        if (disks_[j].x - disks_[j].radius > disk.x + disk.radius) break;
        add_crossings(disk, disks_[j]);
      }
    }
    std::sort(abscissae_.begin(), abscissae_.end());
  }

  /// Takes middle ± reach; a reach that is no number is none.
  void add(double middle, double reach) {
    for (const double x : {middle - reach, middle + reach}) {
      if (x > rectangle_.lo[0] && x < rectangle_.hi[0]) abscissae_.push_back(x);
    }
  }

  void add_crossings(const Disk& a, const Disk& b) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double square = dx * dx + dy * dy;
    if (square == 0.0) return;
    const double along =
        0.5 * (1.0 + (a.radius - b.radius) * (a.radius + b.radius) / square);  // of the distance
    const double across = std::sqrt(a.radius * a.radius / square - along * along);
    add(a.x + along * dx, across * dy);
  }

  double strip(std::span<const Disk* const> disks, double a, double b) {
    const double middle = 0.5 * (a + b);
    intervals_.clear();
    for (const Disk* disk : disks) {
      const double t = middle - disk->x;
      const double reach = std::sqrt((disk->radius - t) * (disk->radius + t));
      Interval interval{{disk->y - reach, disk, -1.0}, {disk->y + reach, disk, 1.0}};
      if (interval.lower.at >= rectangle_.hi[1] || interval.upper.at <= rectangle_.lo[1]) continue;
      if (interval.lower.at < rectangle_.lo[1]) interval.lower = {rectangle_.lo[1], nullptr, 0.0};
      if (interval.upper.at > rectangle_.hi[1]) interval.upper = {rectangle_.hi[1], nullptr, 0.0};
      intervals_.push_back(interval);
    }
    std::sort(intervals_.begin(), intervals_.end(),
              [](const Interval& p, const Interval& q) { return p.lower.at < q.lower.at; });
    double sum = 0.0;
    for (std::size_t i = 0; i < intervals_.size();) {
      const End lower = intervals_[i].lower;
      End upper = intervals_[i].upper;
      for (++i; i < intervals_.size() && intervals_[i].lower.at <= upper.at; ++i) {
        if (intervals_[i].upper.at > upper.at) upper = intervals_[i].upper;
      }
      sum += integral(upper, a, b) - integral(lower, a, b);
    }
    return sum;
  }

  std::vector<Disk> disks_;
  Rectangle rectangle_;
  std::vector<double> abscissae_;
  std::vector<Interval> intervals_;
};

}  // namespace

double disk_union_area(std::span<const Disk> disks, const Rectangle& rectangle) {
  return Sweep(disks, rectangle).area();
}

}  // namespace barchan
