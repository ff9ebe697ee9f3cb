#pragma once

#include <cstddef>

#include <barchan/core/base/random.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan {

/// Draws a radius [m]: a class by its weight, then uniform within it.
[[nodiscard]] inline double draw_radius(const SizeDistribution& sizes, CounterRandom& random) {
  double total = 0.0;
  for (const RadiusClass& size : sizes.classes) total += size.weight;
  double pick = random.uniform() * total;
  std::size_t chosen = 0;
  while (chosen + 1 < sizes.classes.size() && pick >= sizes.classes[chosen].weight) {
    pick -= sizes.classes[chosen].weight;
    ++chosen;
  }
  return random.uniform(sizes.classes[chosen].min, sizes.classes[chosen].max);
}

}  // namespace barchan
