#pragma once

#include <cstdint>

#include <barchan/core/model/model.hpp>
#include <barchan/core/particles/particle_store.hpp>

namespace barchan {

/// A row from what a deck or file says of a particle. The caller wraps positions and finds cells.
template <int Dim>
void set_particle(ParticleStore<Dim>& store, std::int32_t row, const ParticleData& particle,
                  bool is_bonded);

/// And back.
template <int Dim>
[[nodiscard]] ParticleData particle_at(const ParticleStore<Dim>& store, std::int32_t row);

}  // namespace barchan
