#pragma once

#include <span>

#include <barchan/core/model/model.hpp>
#include <barchan/tasks/strip.hpp>

namespace barchan {

/// Gives the lanes of a strip their particles and bonds of the start. Every rank has all of them at
/// hand and keeps its own.
/// @param cells   of every particle, see cells_of
/// @param places  of this rank's lanes
template <int Dim>
void seed_lanes(Strip<Dim>& strip, const ParticleSet& set, std::span<const CellAt<Dim>> cells,
                std::span<const Placement<Dim>> places);

}  // namespace barchan
