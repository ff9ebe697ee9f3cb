#pragma once

#include <cstdint>
#include <vector>

#include <barchan/core/particles/particle_store.hpp>

namespace barchan {

/// Row i gets what row source[i] held, in place: cycle by cycle, so that no second copy of the
/// particles is needed, but of what they carry. `external` moves along if it has as many rows.
///
/// @param source  a permutation of the store's first rows; the identity afterwards
template <int Dim>
void move_rows(ParticleStore<Dim>& store, std::vector<std::int32_t>& source);

}  // namespace barchan
