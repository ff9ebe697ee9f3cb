#pragma once

#include <span>

#include <barchan/core/model/model.hpp>
#include <barchan/tasks/strip.hpp>

namespace barchan {

/// Gives the lanes of a strip their particles and bonds of the start. Every rank has all of them at
/// hand and keeps its own.
/// @param slabs  of every particle, see slabs_of
/// @param cuts   of this rank's lanes: lane l has the slabs cuts[l] … cuts[l+1] - 1
template <int Dim>
void seed_lanes(Strip<Dim>& strip, const ParticleSet& set, std::span<const int> slabs,
                std::span<const int> cuts);

}  // namespace barchan
