#pragma once

#include <span>

#include <barchan/core/brick/brick.hpp>
#include <barchan/core/kernels/pair_job.hpp>
#include <barchan/core/links/walls.hpp>

// What contacts lose in a step is booked by what takes it (World::accounts), and warms the two
// particles alike (HeatTable::dissipates); at a wall all of it warms the particle.

namespace barchan {

/// Of these pairs. @pre the law has not yet worked on them: histories are those before the step
/// @param counts  the pairs count here, and not on the other side of a cut
template <int Dim>
void dissipate(Brick<Dim>& brick, const PairJob& pairs, double kick, bool counts);

/// Of contacts with walls.
template <int Dim>
void dissipate(Brick<Dim>& brick, std::span<const WallLoss> losses);

}  // namespace barchan
