#include <algorithm>
#include <cmath>
#include <numeric>

#include <barchan/core/generators/draw_radius.hpp>
#include <barchan/core/generators/packing.hpp>

namespace barchan {
namespace {

constexpr int kFirstSweeps = 1500;
constexpr int kSweeps = 300;
constexpr int kMaxRounds = 150;

/// The fraction from which squeezed grains are taken out: that of random packings less what walls
/// cost, which is a layer of about half (2D) or a third (3D) of the mean radius along each
/// (measured).
double densest_fraction(const PackSpace& space, const SizeDistribution& sizes) {
  const int dimension = space.box.dimension;
  double weight = 0.0, mean = 0.0;
  for (const RadiusClass& size : sizes.classes) {
    weight += size.weight;
    mean += size.weight * 0.5 * (size.min + size.max);
  }
  const double layer = (dimension == 2 ? 0.5 : 0.35) * mean / weight;
  double fraction = random_close_fraction(sizes, dimension);
  for (int axis = 0; axis < dimension; ++axis) {
    if (space.box.periodic[static_cast<std::size_t>(axis)]) continue;
    fraction *= 1.0 - 2.0 * layer / (space.box.hi[axis] - space.box.lo[axis]);
  }
  return fraction;
}

std::vector<Grain> draw_grains(const PackSpace& space, const SizeDistribution& sizes, double volume,
                               CounterRandom& random) {
  std::vector<Grain> grains;
  const PairSpace& box = space.box;
  double missing = volume;
  while (missing > 0.0) {
    Grain grain;
    grain.radius = draw_radius(sizes, random);
    const double own = solid_volume(grain.radius, box.dimension);
    if (own > 2.0 * missing) break;
    missing -= own;
    for (int attempt = 0; attempt < 100; ++attempt) {
      for (int axis = 0; axis < box.dimension; ++axis) {
        const double margin = box.periodic[static_cast<std::size_t>(axis)] ? 0.0 : grain.radius;
        grain.position[axis] = random.uniform(box.lo[axis] + margin, box.hi[axis] - margin);
      }
      if (space.intrusion(grain) <= 0.0) break;
    }
    grains.push_back(grain);
  }
  return grains;
}

/// Takes out the most squeezed grains, none of them in contact with another one taken out, at most
/// `limit`.
void remove_squeezed(const PackSpace& space, std::vector<Grain>& grains,
                     std::span<const double> ratios, std::size_t limit) {
  std::vector<std::uint32_t> order(grains.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return ratios[a] != ratios[b] ? ratios[a] > ratios[b] : a < b;
  });
  std::vector<std::vector<std::uint32_t>> touching(grains.size());
  for_each_close_pair(space.box, grains, 0.0, [&](std::uint32_t i, std::uint32_t j) {
    touching[i].push_back(j);
    touching[j].push_back(i);
    return true;
  });
  std::vector<bool> keeps(grains.size(), false);
  std::vector<bool> goes(grains.size(), false);
  std::size_t num_gone = 0;
  for (const std::uint32_t i : order) {
    if (num_gone == limit || ratios[i] <= kPackedOverlap) break;
    if (keeps[i]) continue;
    goes[i] = true;
    ++num_gone;
    for (const std::uint32_t j : touching[i]) keeps[j] = true;
  }
  std::size_t at = 0;
  std::erase_if(grains, [&](const Grain&) { return goes[at++]; });
}

}  // namespace

std::vector<Grain> pack_space(const PackSpace& space, const SizeDistribution& sizes,
                              double fraction, CounterRandom& random) {
  for (int axis = 0; axis < space.box.dimension; ++axis) {
    if (space.box.hi[axis] - space.box.lo[axis] < 2.0 * sizes.max_radius()) return {};
  }
  const double start = std::min(fraction, densest_fraction(space, sizes));
  std::vector<Grain> grains = draw_grains(space, sizes, start * space.volume(), random);
  constexpr double kTarget = 0.5 * kPackedOverlap;
  relax(space, grains, kTarget, kFirstSweeps);
  for (int round = 0; !grains.empty(); ++round) {
    const std::vector<double> ratios = overlap_ratios(space, grains);
    const auto num_squeezed = static_cast<std::size_t>(std::count_if(
        ratios.begin(), ratios.end(), [](double ratio) { return ratio > kPackedOverlap; }));
    if (num_squeezed == 0) break;
    const std::size_t limit = round < kMaxRounds ? 1 + num_squeezed / 40 : grains.size();
    remove_squeezed(space, grains, ratios, limit);
    if (round < kMaxRounds) relax(space, grains, kTarget, kSweeps);
  }
  return grains;
}

}  // namespace barchan
