#pragma once

#include <span>

#include <barchan/core/deck/schema.hpp>

namespace barchan::deck {

std::span<const KeySpec>
run_keys();  ///< top level, domain, time, stages, search, output, checkpoint
std::span<const KeySpec> physics_keys();   ///< materials, pairs, contact, bonds, walls
std::span<const KeySpec> law_keys();       ///< of the laws of contact, in materials and pairs
std::span<const KeySpec> particle_keys();  ///< sources of particles

}  // namespace barchan::deck
