#pragma once

#include <vector>

#include <barchan/core/base/random.hpp>
#include <barchan/core/generators/grain.hpp>
#include <barchan/core/generators/relax.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan {

/// Overlaps that a packing may keep, over the smaller radius of a pair.
inline constexpr double kPackedOverlap = 0.01;

/// About the densest that a random packing of these sizes gets, far from walls: 0.84 for disks and
/// 0.64 for spheres of nearly one size, more for a wider distribution.
[[nodiscard]] double random_close_fraction(const SizeDistribution& sizes, int dimension);

/// Packs one space by drawing grains to `fraction` of its volume, relaxing them from random places,
/// and taking out what is squeezed until no overlap exceeds kPackedOverlap. May end with less than
/// `fraction`, never with more than one grain above. Cost: about 1,000 sweeps over all grains.
[[nodiscard]] std::vector<Grain> pack_space(const PackSpace& space, const SizeDistribution& sizes,
                                            double fraction, CounterRandom& random);

/// As pack_space for spaces of any size in linear time: long axes repeat a packed tile, and grains
/// that reach over an end of the box or into a hole are dropped.
[[nodiscard]] std::vector<Grain> pack_tiled(const PackSpace& space, const SizeDistribution& sizes,
                                            double fraction, CounterRandom& random);

/// The particles of a packing source. Of `count` the lowest remain (against gravity, else along the
/// strip axis); of `solid_fraction` a random choice, so that the fraction is met within 0.5 %.
/// @throws InputError at `place`, telling how many or how much fits
[[nodiscard]] std::vector<Grain> make_packing(const Model& model, const PackingSource& source,
                                              const SourcePlace& place);

}  // namespace barchan
