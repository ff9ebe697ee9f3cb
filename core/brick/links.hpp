#pragma once

#include <vector>

#include <barchan/core/brick/brick.hpp>
#include <barchan/core/brick/link_force.hpp>

namespace barchan {

/// Adds the links of a kind that count in this brick, in any order. Changes no history. Ghosts are
/// up to date.
/// @param dt  over which springs stretch until the next forces [s]; 0 before the first step
template <int Dim>
void list_links(const Brick<Dim>& brick, LinkKind kind, double dt, std::vector<LinkForce>& out);

}  // namespace barchan
