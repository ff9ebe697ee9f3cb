#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/draw_radius.hpp>
#include <barchan/core/generators/lattice.hpp>

namespace barchan {
namespace {

constexpr std::uint64_t kLatticeStream = 3;

/// A lattice as layers of rows of sites: every row is evenly spaced along x.
struct Pattern {
  double along_row = 0.0;  ///< between sites of a row [m]
  double between_rows = 0.0;
  double between_layers = 0.0;
  double shift_row = 0.0;    ///< of odd rows along x
  double shift_layer = 0.0;  ///< of odd layers along x
};

Pattern pattern_of(const LatticeSource& source) {
  using Arrangement = LatticeSource::Arrangement;
  const double s = source.spacing;
  switch (source.arrangement) {
    case Arrangement::Hexagonal:
      return {s, 0.5 * std::sqrt(3.0) * s, s, 0.5 * s, 0.0};
    // The fcc lattice: sites s·√2 apart along x; rows and layers s/√2 apart, each shifted by half.
    case Arrangement::Fcc: {
      const double half = std::sqrt(0.5) * s;
      return {2.0 * half, half, half, half, half};
    }
    case Arrangement::Square:
    case Arrangement::Cubic:
      break;
  }
  return {s, s, s, 0.0, 0.0};
}

/// A vector of length up to `reach` in any direction, uniform over the disk or ball.
Vec3 jitter(double reach, int dimension, CounterRandom& random) {
  while (true) {
    Vec3 shift = Vec3::Zero();
    for (int axis = 0; axis < dimension; ++axis) shift[axis] = random.uniform(-1.0, 1.0);
    if (shift.squaredNorm() <= 1.0) return reach * shift;
  }
}

}  // namespace

std::vector<Grain> make_lattice(const LatticeSource& source, int dimension,
                                const SourcePlace& place) {
  const Pattern pattern = pattern_of(source);
  const double spacing = source.spacing;
  const double largest = source.sizes.max_radius();
  const double margin = largest + source.jitter * (0.5 * spacing - largest);
  const Vec3 first = source.region.lo + Vec3::Constant(0.5 * spacing);
  const Vec3 last = source.region.hi - Vec3::Constant(margin - 1e-9 * spacing);
  const Vec3 room = (last - first).cwiseMax(0.0);
  const double layers = dimension == 2 ? 1.0 : room.z() / pattern.between_layers + 1.0;
  if ((room.x() / pattern.along_row + 1.0) * (room.y() / pattern.between_rows + 1.0) * layers >
      kMostParticles) {
    throw InputError(place, "the lattice has more than 1e9 sites",
                     "give a larger spacing or a smaller region");
  }

  CounterRandom random(source.seed, kLatticeStream);
  std::vector<Grain> grains;
  for (int layer = 0;; ++layer) {
    const double z = dimension == 2 ? 0.0 : first.z() + layer * pattern.between_layers;
    if (dimension == 2 ? layer > 0 : z > last.z()) break;
    for (int row = 0;; ++row) {
      const double y = first.y() + row * pattern.between_rows;
      if (y > last.y()) break;
      const bool is_shifted = ((row % 2 != 0) && pattern.shift_row > 0.0) !=
                              ((layer % 2 != 0) && pattern.shift_layer > 0.0);
      const double begin =
          first.x() + (is_shifted ? std::max(pattern.shift_row, pattern.shift_layer) : 0.0);
      for (int site = 0;; ++site) {
        const double x = begin + site * pattern.along_row;
        if (x > last.x()) break;
        Grain grain{{x, y, z}, draw_radius(source.sizes, random)};
        const double reach = source.jitter * (0.5 * spacing - grain.radius);
        if (reach > 0.0) grain.position += jitter(reach, dimension, random);
        grains.push_back(grain);
      }
    }
  }
  if (grains.empty()) {
    throw InputError(place, "the lattice's region holds no particle",
                     fmt::format("it must be at least {:.4g} m wide along every axis", spacing));
  }
  return grains;
}

}  // namespace barchan
