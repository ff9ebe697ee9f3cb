#pragma once

#include <cstdint>
#include <span>

#include <barchan/core/brick/brick.hpp>
#include <barchan/core/kernels/pair_job.hpp>

// Where many candidates do not touch, a block works only on those that touch or soon may. A narrow
// phase finds them, and packs their pairs, laws and histories to the front of the block. The packed
// pairs serve until particles may have moved far enough for another pair to touch. A pair that
// parts meanwhile has no force and loses its history, as it would in the whole list.
//
//   candidates   | a b c d e f g h | …        histories, unpacked   | a – c – – f g – |
//   mask         | 1 0 1 0 0 1 1 0 |          histories, packed     | a c f g | …

namespace barchan {

/// Narrows a job down to those of its pairs that touch or soon may.
/// @param travel  mean bound of how far the two of a pair have come since lists were made [m]
template <int Dim>
void pick_touching(const Brick<Dim>& brick, PairList& list, PairBlock& block, double travel,
                   PairJob& job);

/// Brings the history of touching pairs back to their candidates' places. Cheap when nothing is
/// packed.
void unpack(PairList& list, PairBlock& block);

}  // namespace barchan
