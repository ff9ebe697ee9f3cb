#pragma once

#include <barchan/core/brick/brick.hpp>
#include <barchan/core/brick/rebuild.hpp>
#include <barchan/core/particles/share.hpp>

// Saving a brick and bringing it back. What lies across a cut is saved on its right: the left
// band's pairs and bonds.

namespace barchan {

/// Everything that the next step depends on, between steps. Reuses the memory of `share`.
/// @pre ghosts are up to date
template <int Dim>
void save(const Brick<Dim>& brick, CheckpointShare& share);

/// Instead of Rebuild::seed: owns the particles of a checked share, and queues the history of
/// contacts, walls and bonds that have an end among them. Rebuild::order() … follow.
/// @pre they lie in the box. Errors: RunError for an id that comes twice
template <int Dim>
void restore(Brick<Dim>& brick, Rebuild<Dim>& rebuild, const Placement<Dim>& at,
             const CheckpointShare& share);

}  // namespace barchan
