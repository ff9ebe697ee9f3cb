// Two sources must not claim the same ground: box, ring and single particles, pair by pair.
#include <algorithm>

#include <fmt/format.h>

#include <barchan/core/deck/readers.hpp>

namespace barchan::deck {

namespace {

/// Ground between two circles (2D) or spheres (3D) of one centre.
struct Annulus {
  Vec3 center;
  double inner = 0.0;
  double outer = 0.0;
};

/// What a source claims.
struct Ground {
  const Box* box = nullptr;
  std::span<const Hole> holes;  ///< of the box
  std::vector<Annulus> annuli;
  bool is_list = false;
};

Ground ground_of(const ParticleSource& source) {
  Ground ground;
  if (const auto* lattice = std::get_if<LatticeSource>(&source.kind)) ground.box = &lattice->region;
  if (const auto* packing = std::get_if<PackingSource>(&source.kind)) {
    ground.box = &packing->region;
    ground.holes = packing->holes;
  }
  if (const auto* ring = std::get_if<RingSource>(&source.kind)) {
    ground.annuli.push_back(
        {ring->center, ring->radius - ring->disk_radius, ring->radius + ring->disk_radius});
  }
  if (const auto* list = std::get_if<ListSource>(&source.kind)) {
    ground.is_list = true;
    for (const ParticleData& particle : list->particles) {
      ground.annuli.push_back({particle.position, 0.0, particle.radius});
    }
  }
  return ground;
}

/// Least and largest distance from a point to the points of a box.
struct Reach {
  double least = 0.0;
  double largest = 0.0;
};

Reach reach(const Vec3& point, const Box& box) {
  const Vec3 below = box.lo - point;
  const Vec3 above = point - box.hi;
  const Vec3 gap = below.cwiseMax(above).cwiseMax(0.0);
  const Vec3 far = below.cwiseAbs().cwiseMax(above.cwiseAbs());
  return {gap.norm(), far.norm()};
}

double slack(double length) {
  return 1e-9 * length;
}

bool overlap(const Box& a, const Box& b, int dimension) {
  for (int axis = 0; axis < dimension; ++axis) {
    const double common = std::min(a.hi[axis], b.hi[axis]) - std::max(a.lo[axis], b.lo[axis]);
    if (common <= slack(a.hi[axis] - a.lo[axis])) return false;
  }
  return true;
}

bool lies_in_hole(const Box& box, std::span<const Hole> holes) {
  for (const Hole& hole : holes) {
    if (reach(hole.center, box).largest <= hole.radius + slack(hole.radius)) return true;
  }
  return false;
}

bool overlap(const Annulus& annulus, const Ground& ground) {
  const Reach distance = reach(annulus.center, *ground.box);
  if (distance.least >= annulus.outer - slack(annulus.outer)) return false;
  if (distance.largest <= annulus.inner + slack(annulus.inner)) return false;
  for (const Hole& hole : ground.holes) {
    const double needed = (annulus.center - hole.center).norm() + annulus.outer;
    if (needed <= hole.radius + slack(hole.radius)) return false;
  }
  return true;
}

bool overlap(const Annulus& a, const Annulus& b) {
  const double distance = (a.center - b.center).norm();
  const double tolerance = slack(a.outer + b.outer);
  const bool is_apart = distance >= a.outer + b.outer - tolerance;
  const bool is_nested =
      distance + a.outer <= b.inner + tolerance || distance + b.outer <= a.inner + tolerance;
  return !is_apart && !is_nested;
}

bool overlap(const Ground& a, const Ground& b, int dimension) {
  if (a.box && b.box) {
    return overlap(*a.box, *b.box, dimension) && !lies_in_hole(*a.box, b.holes) &&
           !lies_in_hole(*b.box, a.holes);
  }
  if (b.box) return overlap(b, a, dimension);
  if (a.is_list && b.is_list) return false;  // one by one: the deck says so
  for (const Annulus& annulus : b.annuli) {
    if (a.box && overlap(annulus, a)) return true;
    for (const Annulus& other : a.annuli) {
      if (overlap(annulus, other)) return true;
    }
  }
  return false;
}

}  // namespace

void check_regions(const std::vector<ParticleSource>& sources, int dimension) {
  std::vector<Ground> grounds;
  for (const ParticleSource& source : sources) grounds.push_back(ground_of(source));
  for (std::size_t b = 1; b < grounds.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (!overlap(grounds[a], grounds[b], dimension)) continue;
      throw InputError(sources[b].place,
                       fmt::format("these particles overlap the region of those in line {}",
                                   sources[a].place.line),
                       "move the regions apart, or keep a hole free in a packing: holes = [{ "
                       "center = ..., radius = ... }]");
    }
  }
}

}  // namespace barchan::deck
