#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/hole_volume.hpp>
#include <barchan/core/generators/lattice.hpp>
#include <barchan/core/generators/packing.hpp>

namespace barchan {
namespace {

constexpr double kMostDirect = 20000.0;  ///< grains packed in one piece
constexpr double kTileGrains = 5000.0;
constexpr std::uint64_t kPackStream = 1;
constexpr std::uint64_t kThinStream = 2;

double mean_volume(const SizeDistribution& sizes, int dimension) {
  double sum = 0.0, weight = 0.0;
  for (const RadiusClass& size : sizes.classes) {
    // The mean of r^d for r uniform in [a, b], by Simpson's rule, which is exact up to r³.
    const double mid = 0.5 * (size.min + size.max);
    sum += size.weight / 6.0 *
           (solid_volume(size.min, dimension) + 4.0 * solid_volume(mid, dimension) +
            solid_volume(size.max, dimension));
    weight += size.weight;
  }
  return sum / weight;
}

double total_volume(std::span<const Grain> grains, int dimension) {
  double sum = 0.0;
  for (const Grain& grain : grains) sum += solid_volume(grain.radius, dimension);
  return sum;
}

/// How a box is cut: along an axis either the whole length once, or equal repeats of a periodic
/// tile.
struct Tiling {
  PairSpace tile;
  std::array<std::int64_t, 3> repeats{1, 1, 1};
};

Tiling make_tiling(const PairSpace& box, double grain_volume, double fraction, double widest) {
  Tiling tiling{box, {1, 1, 1}};
  std::vector<int> axes(static_cast<std::size_t>(box.dimension));
  std::iota(axes.begin(), axes.end(), 0);
  const auto length = [&](int axis) { return box.hi[axis] - box.lo[axis]; };
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return length(a) < length(b); });
  double volume = kTileGrains * grain_volume / fraction;
  for (int rank = 0; rank < box.dimension; ++rank) {
    const int axis = axes[static_cast<std::size_t>(rank)];
    const double edge = std::max(std::pow(volume, 1.0 / (box.dimension - rank)), 8.0 * widest);
    const auto repeats = static_cast<std::int64_t>(length(axis) / edge + 0.25);
    if (repeats > 1) {
      const auto a = static_cast<std::size_t>(axis);
      tiling.repeats[a] = repeats;
      tiling.tile.hi[axis] = box.lo[axis] + length(axis) / static_cast<double>(repeats);
      tiling.tile.periodic[a] = true;
    }
    volume /= tiling.tile.hi[axis] - tiling.tile.lo[axis];
  }
  return tiling;
}

PairSpace box_of(const Model& model, const Box& region) {
  PairSpace box{model.dimension, region.lo, region.hi, {}};
  for (int axis = 0; axis < model.dimension; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    box.periodic[a] = model.domain.periodic[a] && region.lo[axis] <= model.domain.lo[axis] &&
                      region.hi[axis] >= model.domain.hi[axis];
  }
  return box;
}

/// The region of a source, and its holes with the images that reach into it where the domain wraps
/// and the region does not.
PackSpace space_of(const Model& model, const PackingSource& source) {
  PackSpace space{box_of(model, source.region), {}};
  Vec3 period = Vec3::Zero();
  for (int axis = 0; axis < model.dimension; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (model.domain.periodic[a] && !space.box.periodic[a])
      period[axis] = model.domain.hi[axis] - model.domain.lo[axis];
  }
  space.holes = with_images(source.holes, space.box, period);
  return space;
}

/// The axis that a counted packing fills from its lower end: against gravity, else the strip axis.
struct FillAxis {
  int axis = 0;
  bool from_high = false;  ///< gravity points towards the upper end
};

FillAxis fill_axis(const Model& model) {
  FillAxis fill{model.domain.strip_axis, false};
  double strongest = 0.0;
  for (int axis = 0; axis < model.dimension; ++axis) {
    if (std::abs(model.gravity[axis]) <= strongest) continue;
    strongest = std::abs(model.gravity[axis]);
    fill = {axis, model.gravity[axis] > 0.0};
  }
  return fill;
}

/// Keeps the `count` grains that lie lowest on the fill axis, in their order.
void keep_lowest(std::vector<Grain>& grains, std::size_t count, const FillAxis& fill) {
  std::vector<std::uint32_t> order(grains.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto height = [&](std::uint32_t i) {
    const double x = grains[i].position[fill.axis];
    return fill.from_high ? -x : x;
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return height(a) != height(b) ? height(a) < height(b) : a < b;
  });
  order.resize(count);
  std::sort(order.begin(), order.end());
  std::vector<Grain> kept;
  kept.reserve(count);
  for (const std::uint32_t i : order) kept.push_back(grains[i]);
  grains = std::move(kept);
}

/// The part of the space, from the lower end of the fill axis, that `volume` of grains needs with
/// some to spare.
PackSpace lower_part(const PackSpace& whole, const FillAxis& fill, double volume, double spare) {
  PackSpace part = whole;
  const int axis = fill.axis;
  const double length = whole.box.hi[axis] - whole.box.lo[axis];
  double section = 1.0;
  for (int other = 0; other < whole.box.dimension; ++other) {
    if (other != axis) section *= whole.box.hi[other] - whole.box.lo[other];
  }
  const double needed = (volume + hole_volume(whole.box, whole.holes)) / section * spare;
  if (needed >= 0.95 * length) return part;
  bool& wraps = part.box.periodic[static_cast<std::size_t>(axis)];
  if (wraps) part.holes = with_images(whole.holes, whole.box, length * Vec3::Unit(axis));
  wraps = false;
  if (fill.from_high) {
    part.box.lo[axis] = whole.box.hi[axis] - needed;
  } else {
    part.box.hi[axis] = whole.box.lo[axis] + needed;
  }
  return part;
}

std::vector<Grain> pack_count(const PackSpace& space, const PackingSource& source,
                              const FillAxis& fill, const SourcePlace& place) {
  const auto count = static_cast<std::size_t>(*source.count);
  const int dimension = space.box.dimension;
  const double close = random_close_fraction(source.sizes, dimension);
  const double volume = static_cast<double>(count) * mean_volume(source.sizes, dimension) / close;
  for (double spare = 1.06;; spare *= 1.2) {
    PackSpace part = lower_part(space, fill, volume, spare);
    const double margin = 6.0 * source.sizes.max_radius();
    double& top = fill.from_high ? part.box.lo[fill.axis] : part.box.hi[fill.axis];
    top = fill.from_high ? std::max(top - margin, space.box.lo[fill.axis])
                         : std::min(top + margin, space.box.hi[fill.axis]);
    CounterRandom random(source.seed, kPackStream);
    std::vector<Grain> grains = pack_tiled(part, source.sizes, close, random);
    if (grains.size() >= count) {
      keep_lowest(grains, count, fill);
      return grains;
    }
    const bool is_whole = part.box.hi[fill.axis] - part.box.lo[fill.axis] >=
                          0.999 * (space.box.hi[fill.axis] - space.box.lo[fill.axis]);
    if (!is_whole) continue;
    throw InputError(place,
                     fmt::format("a packing of {} particles does not fit into its region", count),
                     fmt::format("{} fit; ask for fewer, or give a larger region or smaller radii",
                                 grains.size()));
  }
}

/// Takes out randomly chosen grains until their volume is at most `volume`.
void thin_out(std::vector<Grain>& grains, double volume, int dimension, std::uint64_t seed) {
  CounterRandom random(seed, kThinStream);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order(grains.size());
  for (std::uint32_t i = 0; i < grains.size(); ++i) order[i] = {random.bits(), i};
  std::sort(order.begin(), order.end());
  double excess = total_volume(grains, dimension) - volume;
  std::vector<bool> goes(grains.size(), false);
  for (const auto& [key, i] : order) {
    const double own = solid_volume(grains[i].radius, dimension);
    if (excess < 0.5 * own) break;
    excess -= own;
    goes[i] = true;
  }
  std::size_t at = 0;
  std::erase_if(grains, [&](const Grain&) { return goes[at++]; });
}

std::vector<Grain> pack_fraction(const PackSpace& space, const PackingSource& source,
                                 const SourcePlace& place) {
  const int dimension = space.box.dimension;
  const double whole = space.volume();
  const double target = *source.solid_fraction;
  const double grain = mean_volume(source.sizes, dimension);
  // Dropping at the ends of a tiled box loses about half a grain's width there.
  double loss = 0.0;
  if (whole * target / grain > kMostDirect) {
    for (int axis = 0; axis < dimension; ++axis) {
      if (space.box.periodic[static_cast<std::size_t>(axis)]) continue;
      loss += 2.2 * source.sizes.max_radius() / (space.box.hi[axis] - space.box.lo[axis]);
    }
    std::vector<Hole> grown = space.holes;
    for (Hole& hole : grown) hole.radius += source.sizes.max_radius();
    loss += (hole_volume(space.box, grown) - hole_volume(space.box, space.holes)) / whole;
  }
  const double densest = random_close_fraction(source.sizes, dimension);
  CounterRandom random(source.seed, kPackStream);
  std::vector<Grain> grains = pack_tiled(
      space, source.sizes, std::min(densest, target * (1.0 + loss) + grain / whole), random);
  thin_out(grains, target * whole, dimension, source.seed);
  const double reached = total_volume(grains, dimension) / whole;
  if (!grains.empty() && reached >= 0.995 * target - 0.5 * grain / whole) return grains;
  throw InputError(
      place, fmt::format("a solid fraction of {:.4g} cannot be packed into this region", target),
      fmt::format("random packing reaches {:.3f} here", reached));
}

}  // namespace

double random_close_fraction(const SizeDistribution& sizes, int dimension) {
  double weight = 0.0, mean = 0.0, square = 0.0;
  for (const RadiusClass& size : sizes.classes) {
    weight += size.weight;
    mean += size.weight * 0.5 * (size.min + size.max);
    square += size.weight * (size.min * size.min + size.min * size.max + size.max * size.max) / 3.0;
  }
  mean /= weight;
  const double spread = std::sqrt(std::max(0.0, square / weight / (mean * mean) - 1.0));
  return dimension == 2 ? 0.845 + 0.02 * spread : 0.640 + 0.07 * spread;
}

std::vector<Grain> pack_tiled(const PackSpace& space, const SizeDistribution& sizes,
                              double fraction, CounterRandom& random) {
  const PairSpace& box = space.box;
  const double grain_volume = mean_volume(sizes, box.dimension);
  if (space.volume() * fraction / grain_volume <= kMostDirect)
    return pack_space(space, sizes, fraction, random);

  const Tiling tiling = make_tiling(box, grain_volume, fraction, 2.0 * sizes.max_radius());
  const std::vector<Grain> tile = pack_space({tiling.tile, {}}, sizes, fraction, random);
  std::vector<Grain> grains;
  grains.reserve(tile.size() * static_cast<std::size_t>(tiling.repeats[0] * tiling.repeats[1] *
                                                        tiling.repeats[2]));
  const Vec3 shift = tiling.tile.hi - tiling.tile.lo;
  const double allowed = kPackedOverlap * sizes.min_radius();
  for (std::int64_t c = 0; c < tiling.repeats[2]; ++c) {
    for (std::int64_t b = 0; b < tiling.repeats[1]; ++b) {
      for (std::int64_t a = 0; a < tiling.repeats[0]; ++a) {
        const Vec3 offset(static_cast<double>(a) * shift.x(), static_cast<double>(b) * shift.y(),
                          static_cast<double>(c) * shift.z());
        for (Grain grain : tile) {
          grain.position += offset;
          if (space.intrusion(grain) > 0.1 * allowed) continue;
          space.confine(grain);
          grains.push_back(grain);
        }
      }
    }
  }
  return grains;
}

std::vector<Grain> make_packing(const Model& model, const PackingSource& source,
                                const SourcePlace& place) {
  const PackSpace space = space_of(model, source);
  for (int axis = 0; axis < model.dimension; ++axis) {
    const double length = source.region.hi[axis] - source.region.lo[axis];
    if (length >= 2.0 * source.sizes.max_radius()) continue;
    throw InputError(
        place, fmt::format("the region is {:.4g} m wide along {}", length, "xyz"[axis]),
        fmt::format("the largest particle needs {:.4g} m", 2.0 * source.sizes.max_radius()));
  }
  const double wanted = source.count ? static_cast<double>(*source.count)
                                     : *source.solid_fraction * space.volume() /
                                           mean_volume(source.sizes, model.dimension);
  if (wanted > kMostParticles) {
    throw InputError(place, fmt::format("the packing would have {:.3g} particles", wanted),
                     "at most 1e9: larger radii or a smaller region");
  }
  if (!(space.volume() > 0.0))
    throw InputError(place, "the holes of this packing leave no room in its region",
                     "make them smaller, or the region larger");
  if (source.count) return pack_count(space, source, fill_axis(model), place);
  return pack_fraction(space, source, place);
}

}  // namespace barchan
