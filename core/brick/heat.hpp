#pragma once

#include <span>

#include <barchan/core/brick/brick.hpp>
#include <barchan/core/brick/measures.hpp>
#include <barchan/core/kernels/pair_job.hpp>

// Heat in a brick whose particles have temperatures.
//
//   conduct    every contact of a block: Q = h·(T_j − T_i) into i, and its negative into j, rounded
//              to the grain of flows, so that sums have no order (force_grain.hpp) and what one
//              particle loses another gains, to the bit
//   warm       rows that are complete: T += dt·(Q + walls) / (m·c)
//
// A temperature has a remainder: what rounding to doubles loses in a step is made up for in later
// ones, so that small flows add up, and no heat is lost over any number of steps.

namespace barchan {

/// Adds the flows through the contacts of these pairs to their rows.
/// @pre the law has just worked on them: histories say which contacts hold beyond touch
template <int Dim>
void conduct(Brick<Dim>& brick, const PairJob& pairs);

/// A step of these rows, whose flows are complete; they start anew. @pre positions before the step
template <int Dim>
void warm(Brick<Dim>& brick, Rows rows);

/// Heat and temperatures of owned rows are added to `m`.
template <int Dim>
void measure_heat(const Brick<Dim>& brick, Measures& m);
/// What walls would give in the next step is added to `sums`, one a wall.
template <int Dim>
void measure_wall_heat(const Brick<Dim>& brick, std::span<WallSums> sums);

}  // namespace barchan
