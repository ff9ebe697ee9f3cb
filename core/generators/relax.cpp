#include <algorithm>
#include <cmath>
#include <limits>

#include <barchan/core/generators/hole_volume.hpp>
#include <barchan/core/generators/relax.hpp>

namespace barchan {
namespace {

/// State of the minimisation: soft grains of unit mass and stiffness.
class SoftGrains {
 public:
  SoftGrains(const PackSpace& space, std::vector<Grain>& grains)
      : space_(space),
        grains_(grains),
        velocity_(grains.size(), Vec3::Zero()),
        force_(grains.size(), Vec3::Zero()) {
    double mean = 0.0;
    for (const Grain& grain : grains_) mean += grain.radius;
    mean_radius_ = mean / static_cast<double>(grains_.size());
    list_pairs();
  }

  /// Forces of the present positions; returns the largest overlap over the smaller radius.
  double compute_forces() {
    if (2.0 * travelled_ > skin_) list_pairs();
    std::fill(force_.begin(), force_.end(), Vec3::Zero());
    sum_overlap_ = 0.0;
    num_overlaps_ = 0;
    double worst = 0.0;
    for (const auto& [i, j] : pairs_) {
      const double reach = grains_[i].radius + grains_[j].radius;
      const Vec3 d = space_.box.difference(grains_[i].position, grains_[j].position);
      const double square = d.squaredNorm();
      if (square >= reach * reach) continue;
      const double distance = std::sqrt(square);
      const Vec3 push =
          distance > 0.0 ? Vec3(d * ((reach - distance) / distance)) : Vec3(reach, 0.0, 0.0);
      force_[i] += push;
      force_[j] -= push;
      worst = std::max(worst, (reach - distance) / std::min(grains_[i].radius, grains_[j].radius));
      sum_overlap_ += reach - distance;
      ++num_overlaps_;
    }
    for (std::size_t i = 0; i < grains_.size(); ++i) worst = std::max(worst, add_borders(i));
    return worst;
  }

  /// One step of FIRE.
  void advance() {
    double power = 0.0, force2 = 0.0, speed2 = 0.0;
    for (std::size_t i = 0; i < grains_.size(); ++i) {
      power += force_[i].dot(velocity_[i]);
      force2 += force_[i].squaredNorm();
      speed2 += velocity_[i].squaredNorm();
    }
    rms_force_ = std::sqrt(force2 / static_cast<double>(grains_.size()));
    adapt(power);
    const double turn = force2 > 0.0 ? mixing_ * std::sqrt(speed2 / force2) : 0.0;
    double longest2 = 0.0;
    const double limit = 0.2 * mean_radius_;
    for (std::size_t i = 0; i < grains_.size(); ++i) {
      if (power < 0.0) velocity_[i].setZero();
      velocity_[i] = (1.0 - mixing_) * velocity_[i] + turn * force_[i] + step_ * force_[i];
      Vec3 move = step_ * velocity_[i];
      if (move.squaredNorm() > limit * limit) move *= limit / move.norm();
      grains_[i].position += move;
      longest2 = std::max(longest2, move.squaredNorm());
    }
    travelled_ += std::sqrt(longest2);
  }

  /// Overlaps remain, but they push each other in balance: no more iterations will help.
  [[nodiscard]] bool is_balanced() const {
    return num_overlaps_ > 0 &&
           rms_force_ < 1e-3 * sum_overlap_ / static_cast<double>(num_overlaps_);
  }

 private:
  static constexpr double kLongestStep = 0.4;  ///< of 2/omega = 0.55 for a grain with six contacts
  static constexpr double kFirstMixing = 0.1;

  void adapt(double power) {
    if (power < 0.0) {
      num_downhill_ = 0;
      step_ *= 0.5;
      mixing_ = kFirstMixing;
    } else if (++num_downhill_ > 5) {
      step_ = std::min(1.1 * step_, kLongestStep);
      mixing_ *= 0.99;
    }
  }

  void list_pairs() {
    for (Grain& grain : grains_) wrap(grain);
    pairs_.clear();
    skin_ = kSkin * mean_radius_;
    for_each_close_pair(space_.box, grains_, skin_, [&](std::uint32_t i, std::uint32_t j) {
      pairs_.push_back({i, j});
      return true;
    });
    travelled_ = 0.0;
  }

  void wrap(Grain& grain) const {
    for (int axis = 0; axis < space_.box.dimension; ++axis) {
      if (!space_.box.periodic[static_cast<std::size_t>(axis)]) continue;
      const double length = space_.box.hi[axis] - space_.box.lo[axis];
      grain.position[axis] -=
          length * std::floor((grain.position[axis] - space_.box.lo[axis]) / length);
    }
  }

  double add_borders(std::size_t i) {
    const Grain& grain = grains_[i];
    double deepest = 0.0;
    for (int axis = 0; axis < space_.box.dimension; ++axis) {
      if (space_.box.periodic[static_cast<std::size_t>(axis)]) continue;
      const double low = grain.radius - (grain.position[axis] - space_.box.lo[axis]);
      const double high = grain.radius - (space_.box.hi[axis] - grain.position[axis]);
      if (low > 0.0) force_[i][axis] += low;
      if (high > 0.0) force_[i][axis] -= high;
      deepest = std::max({deepest, low, high});
    }
    for (const Hole& hole : space_.holes) {
      const Vec3 d = space_.box.difference(grain.position, hole.center);
      const double distance = d.norm();
      const double depth = grain.radius + hole.radius - distance;
      if (depth <= 0.0) continue;
      force_[i] += distance > 0.0 ? Vec3(d * (depth / distance)) : Vec3(depth, 0.0, 0.0);
      deepest = std::max(deepest, depth);
    }
    return deepest / grain.radius;
  }

  static constexpr double kSkin = 0.4;  ///< over the mean radius

  const PackSpace& space_;
  std::vector<Grain>& grains_;
  std::vector<Vec3> velocity_;
  std::vector<Vec3> force_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
  double mean_radius_ = 0.0;
  double skin_ = 0.0;
  double travelled_ = 0.0;
  double step_ = 0.1;
  double mixing_ = kFirstMixing;
  double rms_force_ = 0.0;
  double sum_overlap_ = 0.0;
  std::int64_t num_overlaps_ = 0;
  int num_downhill_ = 0;
};

}  // namespace

double PackSpace::volume() const {
  double whole = 1.0;
  for (int axis = 0; axis < box.dimension; ++axis) whole *= box.hi[axis] - box.lo[axis];
  return std::max(0.0, whole - hole_volume(box, holes));
}

void PackSpace::confine(Grain& grain) const {
  for (const Hole& hole : holes) {
    const Vec3 d = box.difference(grain.position, hole.center);
    const double depth = grain.radius + hole.radius - d.norm();
    if (depth > 0.0 && depth < grain.radius) grain.position += d * (depth / d.norm());
  }
  for (int axis = 0; axis < box.dimension; ++axis) {
    double& x = grain.position[axis];
    const double lo = box.lo[axis];
    const double hi = box.hi[axis];
    if (box.periodic[static_cast<std::size_t>(axis)]) {
      x -= (hi - lo) * std::floor((x - lo) / (hi - lo));
      if (x >= hi) x = lo;
    } else {
      x = std::min(std::max(x, lo + grain.radius), hi - grain.radius);
    }
  }
}

double PackSpace::intrusion(const Grain& grain) const {
  double deepest = 0.0;
  for (int axis = 0; axis < box.dimension; ++axis) {
    if (box.periodic[static_cast<std::size_t>(axis)]) continue;
    deepest = std::max({deepest, grain.radius - (grain.position[axis] - box.lo[axis]),
                        grain.radius - (box.hi[axis] - grain.position[axis])});
  }
  for (const Hole& hole : holes) {
    const double distance = box.difference(grain.position, hole.center).norm();
    deepest = std::max(deepest, grain.radius + hole.radius - distance);
  }
  return deepest;
}

void relax(const PackSpace& space, std::vector<Grain>& grains, double tolerance,
           int max_iterations) {
  if (grains.empty()) return;
  SoftGrains soft(space, grains);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    if (soft.compute_forces() <= tolerance) break;
    soft.advance();
    if (soft.is_balanced()) break;
  }
  for (Grain& grain : grains) space.confine(grain);
}

std::vector<double> overlap_ratios(const PackSpace& space, std::span<const Grain> grains) {
  constexpr double kMuchLarger = 1.5;
  std::vector<double> worst(grains.size());
  for (std::size_t i = 0; i < grains.size(); ++i)
    worst[i] = space.intrusion(grains[i]) / grains[i].radius;
  for_each_close_pair(space.box, grains, 0.0, [&](std::uint32_t i, std::uint32_t j) {
    const double distance = space.box.difference(grains[i].position, grains[j].position).norm();
    const double reach = grains[i].radius + grains[j].radius;
    const double ratio = (reach - distance) / std::min(grains[i].radius, grains[j].radius);
    if (grains[i].radius < kMuchLarger * grains[j].radius) worst[i] = std::max(worst[i], ratio);
    if (grains[j].radius < kMuchLarger * grains[i].radius) worst[j] = std::max(worst[j], ratio);
    return true;
  });
  return worst;
}

}  // namespace barchan
