#include <barchan/core/model/particle_source.hpp>

#include <algorithm>

namespace barchan {

double SizeDistribution::min_radius() const {
  double radius = classes.front().min;
  for (const RadiusClass& size : classes) radius = std::min(radius, size.min);
  return radius;
}

double SizeDistribution::max_radius() const {
  double radius = 0.0;
  for (const RadiusClass& size : classes) radius = std::max(radius, size.max);
  return radius;
}

}  // namespace barchan
