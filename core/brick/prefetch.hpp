#pragma once

#include <barchan/core/brick/brick.hpp>
#include <barchan/core/kernels/pair_job.hpp>

// Where a brick is larger than the third cache, a step streams all of it from memory. What a block
// needs is prefetched while the block before it is worked on:
//
//   rows    | met already … | first met in the next block | …      one slab on, from memory
//           | met already … | first met again             | …      one line of cells on
//   lists   | this block    | the front of the next block | …
//
// A row is met for the first time by the rows one slab before it, and a slab's work later, when it
// has left the second cache, by the rows one line of cells before it. Both edges follow from the
// cells alone. Pairs around an end of a periodic box, a few, are not prefetched.

namespace barchan {

/// Which rows each block asks for; none where the brick is small.
template <int Dim>
void plan_prefetch(Brick<Dim>& brick);

/// Works on the pairs of a block, and asks for the next one's.
template <int Dim>
void run_with_prefetch(const Brick<Dim>& brick, const RowBlock& block, const PairJob& pairs);

}  // namespace barchan
