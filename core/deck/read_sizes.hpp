#pragma once

#include <barchan/core/deck/table_reader.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan::deck {

/// `radius` of a source: a number, `[min, max]`, or `[{ radius = ..., weight = ... }, ...]`.
SizeDistribution read_sizes(const TableReader& table);

/// Expected area (2D) or volume (3D) of a particle.
double mean_measure(const SizeDistribution& sizes, int dimension);

}  // namespace barchan::deck
