#pragma once

#include <cstdint>
#include <memory>

#include <barchan/core/brick/lane.hpp>

namespace barchan::micro {

/// A dense random packing on its own, with or without a cut through its middle: what one thread
/// works on.
template <int Dim>
struct Sample {
  World<Dim> world;
  std::unique_ptr<Lane<Dim>> lane, right;  ///< `right` only where there is a cut
  std::int64_t touching = 0;               ///< pairs of `lane`
};

/// @param count  particles; radii spread by a tenth about 0.05 (2D) or 0.5 (3D); they touch as in a
///               settled bed and creep, so that contacts have history, but stay where they are
/// @param has_cut  two lanes beside each other, with bands and ghosts
template <int Dim>
std::unique_ptr<Sample<Dim>> make_sample(std::int64_t count, VectorWidth width,
                                         bool has_cut = false);

/// One step of a lane without a cut.
template <int Dim>
void step(Lane<Dim>& lane);

}  // namespace barchan::micro
